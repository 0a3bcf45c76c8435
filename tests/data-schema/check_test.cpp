// SPDX-License-Identifier: GPL-3.0-or-later
// Each possible fault of a file is made, and must be found at its place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/data-schema/texts.hpp"

namespace tacto::schema {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Check : public testing::Test {
 protected:
  void SetUp() override {
    record("oak", {0.25, 1, 0.5, 2, 0.75, 3, 1, 4});
    Texture texture;
    texture.signal.pitch_m = 1e-6;
    texture.signal.values = {1, 2, 3, 4};
    ASSERT_TRUE(write_texture(folder_ / "oak", texture));
  }

  void record(const std::string& name, const std::vector<double>& interleaved) {
    RecordingHeader header;
    header.sample_rate_hz = 1000;
    header.channels.resize(2);
    header.channels[0].name = header.channels[0].quantity = "tangential_force";
    header.channels[0].unit = "N";
    header.channels[1].name = header.channels[1].quantity = "position";
    header.channels[1].unit = "m";
    header.gaps = {{1, 3, 2}, {3, 6, 1}};
    auto writer = RecordingWriter::create(folder_ / name, header, true);
    ASSERT_TRUE(writer) << message(writer.error());
    ASSERT_TRUE(writer->write(interleaved));
    ASSERT_TRUE(writer->close());
  }

  void edit(const std::string& name, const std::string& from, const std::string& to) {
    const std::string text = without_numbers_sum(read_file(folder_ / name).value());
    std::ofstream(folder_ / name) << replaced(text, from, to);
  }

  std::vector<Finding> findings(FileKind kind, const std::string& name) {
    const auto checked = check_file({kind, folder_ / name});
    EXPECT_TRUE(checked) << message(checked.error());
    return checked ? checked->findings : std::vector<Finding>{};
  }

  bool is_read(FileKind kind, const std::string& name) {
    const auto fault = [](const auto& read) {
      return read ? std::nullopt : std::optional(read.error().kind);
    };
    const auto kept = kind == FileKind::recording ? fault(open_recording(folder_ / name))
                                                  : fault(read_texture(folder_ / name));
    if (kept) EXPECT_EQ(*kept, ErrorKind::malformed);
    return !kept;
  }

  // Whether one finding contains both texts.
  static testing::AssertionResult found(const std::vector<Finding>& all, const std::string& where,
                                        const std::string& what) {
    std::string list;
    for (const Finding& each : all) {
      if (each.where.find(where) != std::string::npos && each.what.find(what) != std::string::npos)
        return testing::AssertionSuccess();
      list += "\n  " + each.where + ": " + each.what;
    }
    return testing::AssertionFailure() << "no '" << where << "', '" << what << "' in:" << list;
  }

  tests::TemporaryFolder folder_;
};

TEST_F(Check, CountsOfAnAverageThatCannotBe) {
  Texture texture;
  texture.signal.pitch_m = 1e-6;
  texture.signal.values = {1, 2, 3, 4};
  texture.average = TextureAverage{"position", {0, 0, 0, 0}, {{1}, {2}}, {{0, 2}, {1e-6, 1}}};
  ASSERT_TRUE(write_texture(folder_ / "mean", texture));
  EXPECT_TRUE(findings(FileKind::texture, "mean.texture.json").empty());
  texture.average->counts = {{1e-6, 3}, {0, 2}};
  ASSERT_TRUE(write_texture(folder_ / "mean", texture));
  const auto found = findings(FileKind::texture, "mean.texture.json");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NE(found[0].what.find(" 2 strokes"), std::string::npos);
  EXPECT_NE(found[1].what.find("must increase"), std::string::npos);
}

TEST_F(Check, SoundFilesHaveNoFindings) {
  EXPECT_TRUE(findings(FileKind::recording, "oak.json").empty());
  EXPECT_TRUE(findings(FileKind::texture, "oak.texture.json").empty());
  for (const char* preset : {"wiertlewski2011", "wiertlewski2011-as-printed"}) {
    const auto checked = check_file({FileKind::transducer, preset});
    ASSERT_TRUE(checked);
    EXPECT_TRUE(checked->findings.empty());
  }
}

TEST_F(Check, FindsEverySchemaViolation) {
  edit("oak.json", "\"sample_rate_hz\": 1000.0", "\"sample_rate_hz\": \"fast\"");
  edit("oak.json", "\"scale\"", "\"skale\"");
  const auto all = findings(FileKind::recording, "oak.json");
  EXPECT_TRUE(found(all, "oak.json#/sample_rate_hz", "number"));
  EXPECT_TRUE(found(all, "oak.json#/channels/0", "scale"));
}

TEST_F(Check, FindsUnitsAndGapsThatCannotBe) {
  edit("oak.json", "\"unit\": \"N\"", "\"unit\": \"V\"");
  edit("oak.json", "\"frame\": 3", "\"frame\": 0");
  const auto all = findings(FileKind::recording, "oak.json");
  EXPECT_TRUE(found(all, "#/channels/0/unit", "N"));
  EXPECT_TRUE(found(all, "#/gaps/1/frame", ""));
}

TEST_F(Check, FindsAGapWhoseNumberSaysOtherwise) {
  EXPECT_TRUE(findings(FileKind::recording, "oak.json").empty());
  edit("oak.json", "\"device_sequence\": 6", "\"device_sequence\": 5");
  EXPECT_TRUE(found(findings(FileKind::recording, "oak.json"), "#/gaps/1/device_sequence", "6"));
}

TEST_F(Check, FindsChangedSamples) {
  const std::string path = folder_ / "oak.wav";
  std::string bytes = read_file(path).value();
  bytes.back() ^= 1;
  std::ofstream(path, std::ios::binary) << bytes;
  const auto all = findings(FileKind::recording, "oak.json");
  EXPECT_TRUE(found(all, "oak.wav", "SHA-256"));
  EXPECT_EQ(all.size(), 1u);
}

// One digit of each number that gives the samples their meaning; texts, marks and x_ members are free.
TEST_F(Check, FindsAChangedNumberOfASidecar) {
  struct Change {
    FileKind kind;
    const char *name, *from, *to;
    bool valid;
  };
  const Change changes[] = {
      {FileKind::recording, "oak.json", "\"scale\": ", "\"scale\": 1", false},
      {FileKind::recording, "oak.json", "\"offset\": ", "\"offset\": 1", false},
      {FileKind::recording, "oak.json", "\"quantity\": \"tangential_force\"", "\"quantity\": \"net_force\"",
       false},
      {FileKind::recording, "oak.json", "\"count\": 2", "\"count\": 1", false},
      {FileKind::recording, "oak.json", "\"channels\"", "\"notes\": \"dry\", \"channels\"", true},
      {FileKind::recording, "oak.json", "\"scale\"", "\"x_gain\": 3, \"scale\"", true},
      {FileKind::recording, "oak.json", "\"gaps\"",
       "\"marks\": [{\"frame\": 1, \"label\": \"knot\"}], \"humidity_percent\": 40, \"gaps\"", true},
      {FileKind::texture, "oak.texture.json", "\"pitch_m\": 1e-06", "\"pitch_m\": 1.0000000000000002e-06",
       false},
      {FileKind::texture, "oak.texture.json", "\"source_origin_m\": ", "\"source_origin_m\": 1", false},
      {FileKind::texture, "oak.texture.json", "\"direction\": 1", "\"direction\": -1", false},
      {FileKind::texture, "oak.texture.json", "\"direction\"", "\"surface\": \"elm\", \"direction\"", true}};
  for (const auto& [kind, name, from, to, valid] : changes) {
    const std::string sound = read_file(folder_ / name).value(), changed = replaced(sound, from, to);
    std::ofstream(folder_ / name) << changed;
    const auto all = findings(kind, name);
    EXPECT_EQ(all.empty(), valid) << to;
    if (!valid) EXPECT_TRUE(found(all, std::string(name) + "#/data/numbers_sha256", "remove this member"));
    EXPECT_EQ(is_read(kind, name), valid) << to;
    std::ofstream(folder_ / name) << without_numbers_sum(changed);
    EXPECT_EQ(findings(kind, name).empty(), valid || !std::string(from).starts_with("\"count\"")) << to;
    std::ofstream(folder_ / name) << sound;
  }
}

TEST_F(Check, FindsTruncation) {
  std::filesystem::resize_file(folder_ / "oak.wav", std::filesystem::file_size(folder_ / "oak.wav") - 16);
  EXPECT_TRUE(found(findings(FileKind::recording, "oak.json"), "oak.wav", "truncated"));
  std::filesystem::remove(folder_ / "oak.texture.wav");
  EXPECT_TRUE(found(findings(FileKind::texture, "oak.texture.json"), "oak.texture.wav", ""));
}

TEST_F(Check, FindsTheSampleThatIsNoNumber) {
  record("hole", {0, 1, 0, 2, 0, kNan, 0, HUGE_VAL});
  const auto all = findings(FileKind::recording, "hole.json");
  EXPECT_TRUE(found(all, "channel 'position', sample 2", "the first of 2"));
  EXPECT_EQ(all.size(), 1u);
}

TEST_F(Check, FindsHeadersThatDisagree) {
  edit("oak.json", "\"sample_rate_hz\": 1000", "\"sample_rate_hz\": 999");
  edit("oak.json", "\"frames\": 4", "\"frames\": 5");
  edit("oak.json", "\"float64\"", "\"pcm32\"");
  const auto all = findings(FileKind::recording, "oak.json");
  EXPECT_TRUE(found(all, "oak.wav", "has the rate 1000"));
  EXPECT_TRUE(found(all, "oak.wav", "contains 4 frames"));
  EXPECT_TRUE(found(all, "oak.wav", "64 bit float"));
  edit("oak.texture.json", "\"pitch_m\": 1e-06", "\"pitch_m\": 1e-05");
  EXPECT_TRUE(
      found(findings(FileKind::texture, "oak.texture.json"), "oak.texture.wav", "its sidecar 100000"));
}

TEST_F(Check, FindsATexturesBandAndUnit) {
  edit("oak.texture.json", "\"unit\": \"N\"",
       "\"unit\": \"m\", \"valid_band\": [{\"position_m\": 1, \"low_per_m\": 5, \"high_per_m\": 2},"
       "{\"position_m\": 0, \"low_per_m\": 1, \"high_per_m\": 2}]");
  const auto all = findings(FileKind::texture, "oak.texture.json");
  EXPECT_TRUE(found(all, "#/unit", "is in N"));
  EXPECT_TRUE(found(all, "#/valid_band/0", "upper end"));
  EXPECT_TRUE(found(all, "#/valid_band/1/position_m", "decrease"));
}

TEST_F(Check, FindsCellsThatAreNoDensity) {
  Spectrogram s;
  s.position_m = {1, 2};
  s.bins = 2;
  s.frequency_step_per_m = 1;
  s.cells = {1, 1, static_cast<float>(kNan), 1};
  s.window_m = s.hop_m = s.pitch_m = 1;
  s.unit = "N";
  ASSERT_TRUE(write_spectrogram_nc(folder_ / "oak.nc", std::span(&s, 1)));
  EXPECT_TRUE(found(findings(FileKind::spectrogram, "oak.nc"), "position 1, bin 0", "not a density"));
  std::ofstream(folder_ / "oak.nc") << "text";
  EXPECT_TRUE(found(findings(FileKind::spectrogram, "oak.nc"), "oak.nc", "netCDF"));
}

TEST_F(Check, BrokenJsonIsAFindingANewerVersionAnError) {
  edit("oak.json", "\"1.0\"", "\"1.9\"");
  EXPECT_EQ(check_file({FileKind::recording, folder_ / "oak.json"})->newer_version, "1.9");
  edit("oak.json", "\"1.9\"", "\"7.0\"");
  EXPECT_EQ(check_file({FileKind::recording, folder_ / "oak.json"}).error().kind,
            ErrorKind::unsupported_version);
  edit("oak.json", "{", "{,");
  EXPECT_TRUE(found(findings(FileKind::recording, "oak.json"), "line 1", "JSON"));
}

TEST_F(Check, AStemStandsForAllThatIsUnderIt) {
  const auto all = stored_files(folder_ / "oak");
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 2u);
  EXPECT_EQ((*all)[0].kind, FileKind::recording);
  EXPECT_EQ((*all)[1].kind, FileKind::texture);
  EXPECT_EQ(stored_files(folder_ / "oak.texture.wav")->front().path, folder_ / "oak.texture.json");
  EXPECT_EQ(stored_files(folder_ / "oak.wav")->front().path, folder_ / "oak.json");
  EXPECT_EQ(stored_files("wiertlewski2011")->front().kind, FileKind::transducer);
  EXPECT_EQ(stored_files(folder_ / "ash").error().kind, ErrorKind::not_found);
}

}  // namespace
}  // namespace tacto::schema
