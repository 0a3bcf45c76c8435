// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "data-schema/files/files.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/spectrogram/spectrogram_writer.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

Spectrogram example(std::size_t positions, const char* name) {
  Spectrogram s;
  s.bins = 65;
  s.frequency_step_per_m = 250;
  s.hop_m = 1e-3;
  s.window_m = 10e-3;
  s.pitch_m = 1e-6;
  s.padded_samples = 128;
  s.window = "blackman";
  s.quantity = "tangential_force";
  s.unit = "N";
  s.name = name;
  for (std::size_t p = 0; p < positions; ++p) s.position_m.push_back(5e-3 + 1e-3 * static_cast<double>(p));
  for (std::size_t i = 0; i < positions * s.bins; ++i) s.cells.push_back(1e-9F * static_cast<float>(i + 1));
  return s;
}

void expect_same(const Spectrogram& read, const Spectrogram& wrote) {
  EXPECT_EQ(read.name, wrote.name);
  EXPECT_EQ(read.window, "blackman");
  EXPECT_EQ(read.quantity, wrote.quantity);
  EXPECT_EQ(read.unit, wrote.unit);
  EXPECT_EQ(read.bins, wrote.bins);
  EXPECT_EQ(read.padded_samples, wrote.padded_samples);
  EXPECT_EQ(read.scaling, wrote.scaling);
  EXPECT_EQ(read.coherent_gain, wrote.coherent_gain);
  EXPECT_EQ(read.decimation, wrote.decimation);
  ASSERT_EQ(read.known.size(), wrote.known.size());
  for (std::size_t p = 0; p < wrote.known.size(); ++p) {
    EXPECT_DOUBLE_EQ(read.known[p].low_per_m, wrote.known[p].low_per_m);
    EXPECT_DOUBLE_EQ(read.known[p].high_per_m, wrote.known[p].high_per_m);
  }
  // Millimetres and back: one rounding each way.
  EXPECT_DOUBLE_EQ(read.frequency_step_per_m, wrote.frequency_step_per_m);
  EXPECT_DOUBLE_EQ(read.window_m, wrote.window_m);
  EXPECT_DOUBLE_EQ(read.hop_m, wrote.hop_m);
  EXPECT_DOUBLE_EQ(read.pitch_m, wrote.pitch_m);
  ASSERT_EQ(read.position_m.size(), wrote.position_m.size());
  ASSERT_EQ(read.cells.size(), wrote.cells.size());
  for (std::size_t p = 0; p < wrote.position_m.size(); ++p)
    EXPECT_DOUBLE_EQ(read.position_m[p], wrote.position_m[p]);
  for (std::size_t i = 0; i < wrote.cells.size(); ++i) EXPECT_FLOAT_EQ(read.cells[i], wrote.cells[i]);
}

class SpectrogramFile : public testing::Test {
 protected:
  std::string path(const char* name = "oak.nc") { return folder_ / name; }
  tests::TemporaryFolder folder_;
};

TEST_F(SpectrogramFile, ReadsBackOne) {
  const std::array all = {example(20, "oak")};
  ASSERT_TRUE(write_spectrogram_nc(path(), all));
  const auto read = read_spectrogram_nc(path());
  ASSERT_TRUE(read) << message(read.error());
  expect_same(*read, all[0]);
  EXPECT_EQ(read->strokes, 1u);
  EXPECT_EQ(folder_.files(), 1u);
}

TEST_F(SpectrogramFile, ReadsBackSeveralOfUnequalLength) {
  const std::array all = {example(12, "oak-01"), example(20, "oak-02"), example(3, "oak-03")};
  ASSERT_TRUE(write_spectrogram_nc(path(), all));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto read = read_spectrogram_nc(path(), i);
    ASSERT_TRUE(read) << message(read.error());
    expect_same(*read, all[i]);
    EXPECT_EQ(read->strokes, 3u);
  }
  EXPECT_EQ(read_spectrogram_nc(path(), 3).error().kind, ErrorKind::unsuitable);
}

TEST_F(SpectrogramFile, KeepsAmplitudesAndWhatIsKnown) {
  std::array all = {example(12, "oak-01"), example(20, "oak-02"), example(3, "oak-03")};
  for (Spectrogram& each : all) {
    each.scaling = Scaling::amplitude;
    each.coherent_gain = 0.42;
    each.decimation = 16;
  }
  for (std::size_t p = 0; p < 20; ++p) all[1].known.push_back({300.0 + static_cast<double>(p), 8000});
  for (const bool compress : {false, true}) {
    ASSERT_TRUE(write_spectrogram_nc(path(), all, compress));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto read = read_spectrogram_nc(path(), i);
      ASSERT_TRUE(read) << message(read.error());
      expect_same(*read, all[i]);
    }
  }
}

// Written row by row or in pieces of any size, the file is the same to the byte.
TEST_F(SpectrogramFile, RowsMakeTheSameFileAsAllAtOnce) {
  const std::array all = {example(12, "oak-01"), example(20, "oak-02")};
  ASSERT_TRUE(write_spectrogram_nc(path("a.nc"), all));
  ASSERT_TRUE(write_spectrogram_csv(path("a.csv"), all));
  for (const auto& [open, name, whole] : {std::tuple(&open_spectrogram_nc, "b.nc", "a.nc"),
                                          std::tuple(&open_spectrogram_csv, "b.csv", "a.csv")}) {
    auto writer = open(path(name), {.several = true});
    ASSERT_TRUE(writer);
    for (const Spectrogram& each : all) {
      ASSERT_TRUE((*writer)->begin(each));
      for (std::size_t row = 0; row < each.position_m.size(); row += 5) {
        const std::size_t rows = std::min<std::size_t>(5, each.position_m.size() - row);
        ASSERT_TRUE((*writer)->rows(row, std::span(each.cells).subspan(row * each.bins, rows * each.bins)));
      }
    }
    ASSERT_TRUE((*writer)->close());
    EXPECT_EQ(sha256_of_file(path(name)).value(), sha256_of_file(path(whole)).value()) << name;
  }
}

TEST_F(SpectrogramFile, EqualSpectrogramsGiveEqualFiles) {
  const std::array all = {example(20, "oak")};
  ASSERT_TRUE(write_spectrogram_nc(path("a.nc"), all));
  ASSERT_TRUE(write_spectrogram_nc(path("b.nc"), all));
  EXPECT_EQ(sha256_of_file(path("a.nc")).value(), sha256_of_file(path("b.nc")).value());
}

TEST_F(SpectrogramFile, RefusesOtherAxesAndNames) {
  std::array all = {example(20, "oak"), example(20, "ash")};
  all[1].frequency_step_per_m = 125;
  const auto written = write_spectrogram_nc(path(), all);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::unsuitable);
  EXPECT_NE(message(written.error()).find("ash: its frequency axes differ"), std::string::npos);
  EXPECT_FALSE(write_spectrogram_csv(path("oak.csv"), all));
  EXPECT_FALSE(write_spectrogram_nc(path(), {}));
  EXPECT_EQ(folder_.files(), 0u);
  EXPECT_EQ(write_spectrogram_nc("/proc/absent/oak.nc", std::span(all).first(1)).error().kind,
            ErrorKind::cannot_write);
}

TEST_F(SpectrogramFile, RefusesForeignAndBrokenFiles) {
  EXPECT_EQ(read_spectrogram_nc(path()).error().kind, ErrorKind::not_found);
  PendingFiles pending;
  ASSERT_TRUE(pending.write(path(), "no netCDF"));
  ASSERT_TRUE(pending.commit());
  EXPECT_EQ(read_spectrogram_nc(path()).error().kind, ErrorKind::malformed);

  const std::array all = {example(20, "oak")};
  ASSERT_TRUE(write_spectrogram_nc(path(), all));
  std::filesystem::resize_file(path(), std::filesystem::file_size(path()) / 2);
  EXPECT_EQ(read_spectrogram_nc(path()).error().kind, ErrorKind::malformed);
}

TEST_F(SpectrogramFile, TableSaysItsUnits) {
  Spectrogram s = example(2, "oak");
  s.bins = 3;
  s.cells = {0, 1e-3F, 2.5e-3F, 3e-3F, 4e-3F, 5e-3F};
  ASSERT_TRUE(write_spectrogram_csv(path("one.csv"), std::array{s}));
  EXPECT_EQ(read_file(path("one.csv")).value(),
            "position_mm,N2 mm at 0/mm,N2 mm at 0.25/mm,N2 mm at 0.5/mm\n5,0,1,2.5\n6,3,4,5\n");
  ASSERT_TRUE(write_spectrogram_csv(path("two.csv"), std::array{s, s}));
  EXPECT_EQ(read_file(path("two.csv")).value(),
            "stroke,position_mm,N2 mm at 0/mm,N2 mm at 0.25/mm,N2 mm at 0.5/mm\n"
            "1,5,0,1,2.5\n1,6,3,4,5\n2,5,0,1,2.5\n2,6,3,4,5\n");
  s.scaling = Scaling::amplitude;
  s.known = {{100, 400}, {125, 500}};
  ASSERT_TRUE(write_spectrogram_csv(path("known.csv"), std::array{s}));
  EXPECT_EQ(read_file(path("known.csv")).value(),
            "position_mm,known_from_per_mm,known_to_per_mm,N at 0/mm,N at 0.25/mm,N at 0.5/mm\n"
            "5,0.1,0.4,0,0.001,0.0025\n6,0.125,0.5,0.003,0.004,0.005\n");
}

}  // namespace
}  // namespace tacto::schema
