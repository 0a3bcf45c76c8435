// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/wav/wav.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/data-schema/texts.hpp"

namespace tacto::schema {
namespace {

Texture example() {
  Texture texture;
  texture.signal.pitch_m = 1e-6;
  for (int i = 0; i < 5000; ++i) texture.signal.values.push_back(std::sin(0.01 * i) * 0.3);
  texture.direction = -1;
  texture.source_origin_m = 0.0914;
  texture.valid_band = {{0, 375, 12500}, {0.002, 300, 1e4}};
  texture.source = {"oak.json", std::string(64, 'a'),
                    4.55,       6.85,
                    2,          "hermite",
                    "fourier",  "treated",
                    4,          15,
                    500,        true,
                    0.04,       0.03,
                    0.05,       2e-7,
                    1e-6,       3e-6,
                    16,         2,
                    0.4,        true};
  texture.surface = "oak";
  texture.created = "2024-05-01T12:00:00Z";
  texture.creator = "a test";
  return texture;
}

class TextureFile : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder_ / name, text));
    ASSERT_TRUE(pending.commit());
  }
  std::string sidecar() { return read_file(folder_ / "oak.texture.json").value(); }
  Error error_of(const std::string& name) {
    const auto read = read_texture(folder_ / name);
    EXPECT_FALSE(read);
    return read ? Error{} : read.error();
  }
  tests::TemporaryFolder folder_;
};

TEST_F(TextureFile, ReadsBack) {
  const Texture wrote = example();
  ASSERT_TRUE(write_texture(folder_ / "oak", wrote));
  EXPECT_EQ(folder_.files(), 2u);
  for (const char* name : {"oak", "oak.texture.json", "oak.texture.wav"}) {
    const auto read = read_texture(folder_ / name);
    ASSERT_TRUE(read) << message(read.error());
    ASSERT_EQ(read->signal.values.size(), wrote.signal.values.size());
    for (std::size_t i = 0; i < wrote.signal.values.size(); ++i)
      ASSERT_EQ(read->signal.values[i],
                static_cast<float>(wrote.signal.values[i]));  // the WAV is single precision
    EXPECT_EQ(read->signal.pitch_m, 1e-6);
    EXPECT_EQ(read->signal.origin_m, 0);
    EXPECT_EQ(read->direction, -1);
    EXPECT_EQ(read->source_origin_m, 0.0914);
    ASSERT_EQ(read->valid_band.size(), 2u);
    EXPECT_EQ(read->valid_band[1].high_per_m, 1e4);
    EXPECT_EQ(read->source.recording, "oak.json");
    EXPECT_EQ(read->source.stroke, 2);
    EXPECT_EQ(read->source.order, 4);
    EXPECT_EQ(read->source.position_moved_m, 2e-7);
    EXPECT_EQ(read->source.position_quantum_m, 1e-6);
    EXPECT_EQ(read->source.position_noise_m, 3e-6);
    EXPECT_EQ(read->source.counter_bits, 16);
    EXPECT_EQ(read->source.counter_wraps, 2);
    EXPECT_EQ(read->source.normal_force_n, 0.4);
    EXPECT_TRUE(read->source.finger_up);
    EXPECT_EQ(read->source.max_speed_mps, 0.05);
    EXPECT_TRUE(read->source.equalised);
    EXPECT_EQ(read->surface, "oak");
    EXPECT_EQ(read->creator, "a test");
  }
}

TEST_F(TextureFile, HeaderRateIsSamplesPerMetre) {
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  const auto wav = WavReader::open(folder_ / "oak.texture.wav");
  ASSERT_TRUE(wav);
  EXPECT_EQ(wav->info().sample_rate_hz, 1e6);
  EXPECT_EQ(wav->info().frames, 5000u);
  EXPECT_EQ(wav->info().channels, 1u);
}

Texture average_example() {
  Texture texture = example();
  texture.average = TextureAverage{"correlation",
                                   std::vector<double>(texture.signal.values.size(), 0.02),
                                   {{1, 0.5, 1, 1, 0}, {3, 2.5, 3, 1, -1.25e-5, 0.93}},
                                   {{0, 1}, {0.001, 2}}};
  return texture;
}

TEST_F(TextureFile, AnAverageKeepsItsSpreadAndStrokes) {
  ASSERT_TRUE(write_texture(folder_ / "oak", average_example()));
  const auto read = read_texture(folder_ / "oak");
  ASSERT_TRUE(read) << message(read.error());
  ASSERT_TRUE(read->average);
  EXPECT_EQ(read->signal.values[7], static_cast<float>(example().signal.values[7]));
  EXPECT_EQ(read->average->spread, std::vector<double>(5000, static_cast<double>(0.02F)));
  EXPECT_EQ(read->average->align, "correlation");
  ASSERT_EQ(read->average->strokes.size(), 2U);
  EXPECT_EQ(read->average->strokes[1].stroke, 3);
  EXPECT_EQ(read->average->strokes[1].shift_m, -1.25e-5);
  EXPECT_EQ(read->average->strokes[1].correlation, 0.93);
  EXPECT_FALSE(read->average->strokes[0].correlation);
  ASSERT_EQ(read->average->counts.size(), 2U);
  EXPECT_EQ(read->average->counts[1].strokes, 2);
  EXPECT_NE(sidecar().find("standard_deviation"), std::string::npos);
  EXPECT_EQ(WavReader::open(folder_ / "oak.texture.wav")->info().channels, 2U);
}

TEST_F(TextureFile, ATransformIsKept) {
  Texture made = example();
  TransformStep mix, stretch;
  mix.operation = TransformOperation::mix;
  mix.weights = {1, -0.5};
  stretch.operation = TransformOperation::stretch;
  stretch.factor = 0.7;
  stretch.keep_slope = true;
  stretch.lengthening = Lengthening::best_fit;
  stretch.joints = 1;
  stretch.joint_error = 0.003;
  stretch.removed_above_per_m = 450000;
  stretch.removed_share = 0.1;
  made.transform = TextureTransform{
      {{"oak.texture.json", std::string(64, 'b')}, {"pine.texture.json", std::string(64, 'c')}},
      {mix, stretch}};
  ASSERT_TRUE(write_texture(folder_ / "oak", made));
  const auto read = read_texture(folder_ / "oak");
  ASSERT_TRUE(read) << message(read.error());
  ASSERT_TRUE(read->transform);
  ASSERT_EQ(read->transform->sources.size(), 2U);
  EXPECT_EQ(read->transform->sources[1].texture, "pine.texture.json");
  EXPECT_EQ(read->transform->sources[1].sha256, std::string(64, 'c'));
  ASSERT_EQ(read->transform->steps.size(), 2U);
  EXPECT_EQ(read->transform->steps[0].operation, TransformOperation::mix);
  EXPECT_EQ(read->transform->steps[0].weights, (std::vector<double>{1, -0.5}));
  EXPECT_FALSE(read->transform->steps[0].factor);
  const TransformStep& last = read->transform->steps[1];
  EXPECT_EQ(last.operation, TransformOperation::stretch);
  EXPECT_EQ(last.factor, 0.7);
  EXPECT_EQ(last.keep_slope, true);
  EXPECT_EQ(last.lengthening, Lengthening::best_fit);
  EXPECT_EQ(last.joints, 1);
  EXPECT_EQ(last.joint_error, 0.003);
  EXPECT_EQ(last.removed_above_per_m, 450000);
  EXPECT_EQ(last.removed_share, 0.1);
  EXPECT_FALSE(last.left_out_m);
  ASSERT_TRUE(write_texture(folder_ / "plain", example()));
  EXPECT_FALSE(read_texture(folder_ / "plain")->transform);
}

TEST_F(TextureFile, AnAverageWithoutItsSpreadIsBroken) {
  Texture broken = average_example();
  broken.average->spread.pop_back();
  EXPECT_FALSE(write_texture(folder_ / "oak", broken));
  ASSERT_TRUE(write_texture(folder_ / "oak", average_example()));
  const std::string sound = sidecar();
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  write("oak.texture.json", sound);
  EXPECT_EQ(error_of("oak").kind, ErrorKind::malformed);
  EXPECT_EQ(error_of("oak").where, folder_ / "oak.texture.wav");
}

TEST_F(TextureFile, SaysWhetherItsNameIsFree) {
  EXPECT_TRUE(check_texture_free(folder_ / "oak"));
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  for (const char* name : {"oak", "oak.texture.json", "oak.texture.wav"}) {
    const auto taken = check_texture_free(folder_ / name);
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().kind, ErrorKind::usage);
    EXPECT_NE(message(taken.error()).find("oak.texture.json"), std::string::npos);
  }
}

TEST_F(TextureFile, ManyAppearTogetherOrNotAtAll) {
  {
    PendingFiles pending;
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(add_texture(pending, folder_ / std::to_string(i), example()));
    EXPECT_FALSE(read_texture(folder_ / "0"));
  }
  EXPECT_EQ(folder_.files(), 0U);
  PendingFiles pending;
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(add_texture(pending, folder_ / std::to_string(i), example()));
  ASSERT_TRUE(pending.commit());
  EXPECT_EQ(folder_.files(), 60U);
  EXPECT_TRUE(read_texture(folder_ / "29"));
}

TEST_F(TextureFile, EqualTexturesGiveEqualFiles) {
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  const std::string wav = sha256_of_file(folder_ / "oak.texture.wav").value(), json = sidecar();
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  EXPECT_EQ(sha256_of_file(folder_ / "oak.texture.wav").value(), wav);
  EXPECT_EQ(sidecar(), json);
}

TEST_F(TextureFile, NewerMinorIsReadAndItsMembersKept) {
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  write("oak.texture.json",
        replaced(sidecar(), "\"version\": \"1.0\"", "\"version\": \"1.3\", \"grain\": [1, 2]"));
  const auto read = read_texture(folder_ / "oak");
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(read->newer_version, "1.3");
  ASSERT_TRUE(write_texture(folder_ / "copy", *read));
  const auto copy = read_file(folder_ / "copy.texture.json").value();
  EXPECT_NE(copy.find("\"grain\""), std::string::npos);
  EXPECT_NE(copy.find("copy.texture.wav"), std::string::npos);
  write("oak.texture.json", replaced(sidecar(), "\"1.3\"", "\"2.0\""));
  EXPECT_EQ(error_of("oak").kind, ErrorKind::unsupported_version);
}

TEST_F(TextureFile, ARecordingIsToldApart) {
  RecordingHeader header;
  header.format = SampleFormat::float64;
  header.sample_rate_hz = 1000;
  header.channels.emplace_back();
  header.channels[0].name = header.channels[0].quantity = "tangential_force";
  header.channels[0].unit = "N";
  auto writer = RecordingWriter::create(folder_ / "raw", header);
  ASSERT_TRUE(writer) << message(writer.error());
  ASSERT_TRUE(writer->write(std::vector<double>(10, 0.5)));
  ASSERT_TRUE(writer->close());
  for (const char* name : {"raw", "raw.json", "raw.wav"}) {
    const Error error = error_of(name);
    EXPECT_EQ(error.kind, ErrorKind::unsuitable) << name;
    EXPECT_NE(error.remedy.find("spatial"), std::string::npos) << message(error);
  }
}

TEST_F(TextureFile, TexturesOfTheStrokesAreNamedWhereOneIsMissing) {
  for (const char* name : {"oak-02", "oak-01", "oaks-01"})
    ASSERT_TRUE(write_texture(folder_ / name, example()));
  for (const char* name : {"oak", "oak.texture.json", "oak.texture.wav"}) {
    const Error error = error_of(name);
    EXPECT_EQ(error.kind, ErrorKind::not_found) << name;
    EXPECT_NE(error.remedy.find(folder_ / "oak-01" + ", " + folder_ / "oak-02"), std::string::npos)
        << error.remedy;
    EXPECT_EQ(error.remedy.find("oaks"), std::string::npos) << error.remedy;
  }
}

TEST_F(TextureFile, AbsentBrokenAndDisagreeing) {
  EXPECT_EQ(error_of("nothing").kind, ErrorKind::not_found);
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  const std::string sound = without_numbers_sum(sidecar());

  write("oak.texture.json", replaced(sound, "\"samples\": 5000", "\"samples\": 6000"));
  EXPECT_NE(message(error_of("oak")).find(" 6000"), std::string::npos);
  write("oak.texture.json", replaced(sound, "\"pitch_m\": 1e-06", "\"pitch_m\": 2e-06"));
  EXPECT_EQ(error_of("oak").kind, ErrorKind::malformed);
  write("oak.texture.json", replaced(sound, "\"direction\": -1", "\"direction\": 0"));
  EXPECT_NE(error_of("oak").where.find("#/direction"), std::string::npos);
  write("oak.texture.json", sound);
  std::filesystem::remove(folder_ / "oak.texture.wav");
  EXPECT_EQ(error_of("oak").kind, ErrorKind::not_found);
}

TEST_F(TextureFile, NamesTheSampleThatIsNoNumber) {
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  auto writer = WavWriter::create(folder_ / "oak.texture.wav", 1e6, 1, SampleFormat::float32);
  ASSERT_TRUE(writer);
  auto values = example().signal.values;
  values[1234] = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(writer->write(values));
  ASSERT_TRUE(writer->close());
  EXPECT_NE(message(error_of("oak")).find("sample 1234"), std::string::npos);
}

TEST_F(TextureFile, WritesNothingWhereItCannotWriteAll) {
  Texture broken = example();
  broken.signal.values[7] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(write_texture(folder_ / "oak", broken));
  broken = example();
  broken.direction = 3;
  EXPECT_FALSE(write_texture(folder_ / "oak", broken));
  broken.signal.values.clear();
  EXPECT_FALSE(write_texture(folder_ / "oak", broken));
  EXPECT_EQ(folder_.files(), 0u);
  const auto nowhere = write_texture("/proc/absent/oak", example());
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().kind, ErrorKind::cannot_write);
}

// A saved gain replaces an earlier one; the WAV, its hash and members of a newer version do not change.
TEST_F(TextureFile, KeepsAGainAndAllElse) {
  ASSERT_TRUE(write_texture(folder_ / "oak", example()));
  write("oak.texture.json", replaced(sidecar(), "\"version\"", "\"later\": {\"a\": 1}, \"version\""));
  EXPECT_FALSE(read_playback_gain(folder_ / "oak")->has_value());
  const auto wav = read_file(folder_ / "oak.texture.wav").value();
  for (const double gain_m_per_n : {1e-3, -2.5e-4}) {
    ASSERT_TRUE(write_playback_gain(folder_ / "oak", {gain_m_per_n, "mw", "2026-11-22T21:00:00Z"}));
    const auto kept = read_texture(folder_ / "oak");
    ASSERT_TRUE(kept) << message(kept.error());
    ASSERT_TRUE(kept->playback_gain);
    EXPECT_EQ(kept->playback_gain->gain_m_per_n, gain_m_per_n);
    EXPECT_EQ(kept->playback_gain->who, "mw");
    EXPECT_EQ(kept->playback_gain->when, "2026-11-22T21:00:00Z");
    EXPECT_EQ(kept->signal.values.size(), 5000U);
    EXPECT_EQ(kept->surface, "oak");
  }
  EXPECT_NE(sidecar().find("\"later\""), std::string::npos);
  EXPECT_EQ(read_file(folder_ / "oak.texture.wav").value(), wav);
  const std::string before = sidecar();
  const auto refused = write_playback_gain(
      folder_ / "oak", {std::numeric_limits<double>::quiet_NaN(), "mw", "2026-11-22T21:00:00Z"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(sidecar(), before);
}

}  // namespace
}  // namespace tacto::schema
