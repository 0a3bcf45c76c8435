// SPDX-License-Identifier: GPL-3.0-or-later
// Rows with outliers are left out and become gaps; all other numbers and times are unchanged.
#include "capture/import/outlier_mask.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "data-schema/check/check.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "tests/capture/import_fixture.hpp"

namespace tacto::capture {
namespace {

using schema::Gap;

void expect_gaps(const std::vector<Gap>& found, const std::vector<Gap>& target) {
  ASSERT_EQ(found.size(), target.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].frame, target[i].frame) << i;
    EXPECT_EQ(found[i].device_sequence, target[i].device_sequence) << i;
    EXPECT_EQ(found[i].count, target[i].count) << i;
  }
}

TEST(OutlierMask, RowsBecomeGaps) {
  expect_gaps(OutlierMask().gaps_with({}), {});
  expect_gaps(OutlierMask::of({7, 3, 7}, 1000, "t.csv")->gaps_with({}), {{3, 4, 1}, {6, 8, 1}});
  expect_gaps(OutlierMask::of({0, 9}, 10, "t.csv")->gaps_with({}), {{0, 1, 1}, {8, 10, 1}});
  expect_gaps(OutlierMask::of({3, 4, 5}, 10, "t.csv")->gaps_with({}), {{3, 6, 3}});
}

// Two rows are missing in the source before its row 5, and one before its row 8.
TEST(OutlierMask, GapsOfTheSourceAreCountedWithThem) {
  const std::vector<Gap> source = {{5, 7, 2}, {8, 11, 1}};
  expect_gaps(OutlierMask().gaps_with(source), source);
  expect_gaps(OutlierMask::of({5}, 10, "t.csv")->gaps_with(source), {{5, 8, 3}, {7, 11, 1}});
  expect_gaps(OutlierMask::of({4, 8}, 10, "t.csv")->gaps_with(source), {{4, 7, 3}, {7, 12, 2}});
}

TEST(OutlierMask, RowsAreTakenOutOfPieces) {
  const auto mask = OutlierMask::of({0, 4, 5, 9}, 1000, "t.csv");
  std::vector<double> first = {0, 1, 2, 3, 4}, second = {5, 6, 7, 8}, third = {9};
  mask->erase_from(first, 0);
  mask->erase_from(second, 5);
  mask->erase_from(third, 9);
  EXPECT_EQ(first, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(second, (std::vector<double>{6, 7, 8}));
  EXPECT_TRUE(third.empty());
}

TEST(OutlierMask, ManyRowsAreNoOutliers) {
  std::vector<std::uint64_t> rows(11);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = 3 * i;
  EXPECT_TRUE(OutlierMask::of(rows, 1100, "t.csv"));
  const auto refused = OutlierMask::of(rows, 1000, "t.csv");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_NE(refused.error().what.find("11 of 1000 rows"), std::string::npos);
}

class MaskedImport : public ImportTest {
 protected:
  static constexpr int kRows = 2000, kHole = 700;
  // A sine during a steady movement; with a time column, 5 rows are missing from kHole on.
  static double force(int i) { return std::sin(i / 20.0); }
  std::string table(const std::vector<int>& outliers) const {
    std::string text = "t,f,v\n";
    for (int i = 0; i < kRows; ++i) {
      const bool out = std::ranges::find(outliers, i) != outliers.end();
      if (i < kHole || i >= kHole + 5) text += fmt::format("{},{},{}\n", i, out ? 4581.5 : force(i), 40);
    }
    return write("t.csv", text);
  }
  static void expect_valid(const schema::Recording& recording) {
    const auto files = schema::stored_files(recording.stem);
    ASSERT_TRUE(files);
    for (const auto& file : *files) EXPECT_TRUE(schema::check_file(file)->findings.empty());
  }
  ImportRequest masked(const std::string& file) const {
    ImportRequest made = request(file, {"tangential_force=f*1N", "speed=v*1mm/s"});
    made.rate_hz.reset();
    made.time_column = "t*1ms";
    made.mask_outliers = true;
    return made;
  }
};

TEST_F(MaskedImport, KeepsEveryOtherNumberAndTime) {
  const std::vector<int> outliers = {100, 699, 705, 1500};
  const auto recording = imported(masked(table(outliers)));
  const auto& header = recording.header;
  expect_gaps(header.gaps, {{100, 101, 1}, {698, 706, 7}, {1492, 1501, 1}});
  const auto forces = stored(recording, 0), positions = stored(recording, 2);
  ASSERT_EQ(forces.size(), static_cast<std::size_t>(kRows - 5 - 4));
  for (std::size_t frame = 0; frame < forces.size(); ++frame) {
    const double time_s = schema::frame_time_s(header, frame);
    const int i = static_cast<int>(std::lround(time_s * 1000));
    ASSERT_EQ(forces[frame], std::strtod(fmt::format("{}", force(i)).c_str(), nullptr)) << frame;
    ASSERT_NEAR(positions[frame], 40e-3 * time_s, 1e-12) << frame;  // no jump where rows are missing
  }
  expect_valid(recording);
}

TEST_F(MaskedImport, SaysHowManyAndWhere) {
  const auto done = import(masked(table({100, 1500})));
  ASSERT_TRUE(done) << schema::message(done.error());
  EXPECT_EQ(done->masked_rows, 2U);
  const auto& warnings = done->recording.header.warnings;
  const auto all = fmt::format("{}", fmt::join(warnings, "\n"));
  EXPECT_NE(all.find(" 5 frames"), std::string::npos) << all;
  EXPECT_NE(all.find("line 102, 0.1 s"), std::string::npos) << all;
  EXPECT_NE(all.find("line 1497, 1.5 s"), std::string::npos) << all;
  EXPECT_NE(all.find(": 2 rows"), std::string::npos) << all;
  EXPECT_EQ(done->ranges[0].largest < 1.1, true);
}

// Missing, NaN and infinite values become gaps, as outliers do; without the mask they are refused.
TEST_F(MaskedImport, RowsThatLackAValueBecomeGaps) {
  auto text = fmt::format("t,f,v\n");
  for (int i = 0; i < kRows; ++i) {
    const auto known = fmt::format("{}", force(i));
    const bool spike = i == 50;
    text += fmt::format("{},{},{}\n", i,
                        i == 0     ? ""
                        : i == 300 ? "NaN"
                        : spike    ? "4581.5"
                                   : known,
                        i == 301 ? "inf" : "40");
  }
  auto asked = masked(write("t.csv", text));
  const auto done = import(asked);
  ASSERT_TRUE(done) << schema::message(done.error());
  EXPECT_EQ(done->masked_rows, 4U);
  EXPECT_EQ(done->outliers, 4U);
  expect_gaps(done->recording.header.gaps, {{0, 1, 1}, {49, 51, 1}, {298, 302, 2}});
  for (const double value : stored(done->recording, 0)) ASSERT_LT(std::abs(value), 1.1);
  expect_valid(done->recording);
  asked.mask_outliers = false;
  asked.replace = true;
  const auto refused = import(asked);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, schema::ErrorKind::malformed);
  EXPECT_NE(refused.error().where.find("line 2"), std::string::npos) << refused.error().where;
  EXPECT_NE(refused.error().remedy.find("--mask-outliers"), std::string::npos);
}

TEST_F(MaskedImport, ARowWithoutATimeIsRefused) {
  auto text = fmt::format("t,f,v\n");
  for (int i = 0; i < kRows; ++i)
    text += fmt::format("{},{},40\n", i == 7 ? "" : fmt::format("{}", i), force(i));
  const auto refused = import(masked(write("t.csv", text)));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, schema::ErrorKind::malformed);
  EXPECT_NE(refused.error().where.find("line 9, column 1 ('t')"), std::string::npos) << refused.error().where;
}

TEST_F(MaskedImport, TheEndsMayBeOutliers) {
  const auto recording = imported(masked(table({0, kRows - 1})));
  EXPECT_EQ(recording.header.frames, static_cast<std::uint64_t>(kRows - 5 - 2));
  EXPECT_EQ(recording.header.gaps.front().frame, 0U);
  EXPECT_EQ(schema::frame_time_s(recording.header, 0), 0.001);
  expect_valid(recording);
}

TEST_F(MaskedImport, WithoutOutliersItIsTheSameRecording) {
  auto asked = masked(table({}));
  const auto with = imported(asked);
  const auto bytes = stored(with, 0);
  asked.mask_outliers = false;
  asked.replace = true;
  const auto without = imported(asked);
  EXPECT_EQ(bytes, stored(without, 0));
  EXPECT_EQ(with.header.warnings, without.header.warnings);
  expect_gaps(with.header.gaps, without.header.gaps);
}

TEST_F(MaskedImport, AWrongUnitIsNoOutlier) {
  auto asked = masked(table({}));
  asked.channels[0] = "tangential_force=f*1kN";
  const auto refused = import(asked);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_EQ(refused.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_EQ(folder_.files(), 1U);
}

}  // namespace
}  // namespace tacto::capture
