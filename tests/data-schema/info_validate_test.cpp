// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs `info` and `validate` as commands: arguments in, text and exit code out.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "data-schema/cli/verbs.hpp"
#include "data-schema/command/command.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

struct Outcome {
  int exit_code;
  std::string out, err;
};

Outcome run(std::vector<std::string> arguments) {
  const cli::VerbGroup kGroups[] = {{"See", {&kInfoVerb, &kValidateVerb}}};
  std::vector<const char*> argv = {"tactograph"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = cli::run_command(kGroups, static_cast<int>(argv.size()), argv.data());
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

class InfoValidate : public testing::Test {
 protected:
  void SetUp() override {
    RecordingHeader header;
    header.sample_rate_hz = 1000;
    header.channels.resize(1);
    header.channels[0].name = header.channels[0].quantity = "tangential_force";
    header.channels[0].unit = "N";
    header.channels[0].scale = -2;
    header.channels[0].offset = 1;
    header.channels[0].calibrated = "2024-02-03";
    header.gaps = {{2, 8, 6}};
    header.simulated = "a test";
    header.warnings = {"the finger slipped"};
    auto writer = RecordingWriter::create(oak_, header);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->write(std::vector<double>{0, 1, 2, 1}));
    ASSERT_TRUE(writer->close());

    Texture texture;
    texture.signal.pitch_m = 2e-6;
    texture.signal.values = {3, -4, 3, -4, 3};
    texture.valid_band = {{0, 300, 9000}, {1, 200, 8000}};
    ASSERT_TRUE(write_texture(oak_, texture));
  }

  nlohmann::json json(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const Outcome outcome = run(std::move(arguments));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }

  tests::TemporaryFolder folder_;
  std::string oak_ = folder_ / "oak";
};

TEST_F(InfoValidate, DescribesARecordingInPhysicalUnits) {
  const nlohmann::json info = json({"info", oak_});
  EXPECT_EQ(info["kind"], "recording");
  EXPECT_EQ(info["frames"], 4);
  EXPECT_EQ(info["gaps"], 1);
  EXPECT_EQ(info["missing_frames"], 6);
  EXPECT_DOUBLE_EQ(info["duration_s"].get<double>(), 0.010);  // 4 frames stored, 6 missing, 1 ms each
  EXPECT_EQ(info["simulated"], "a test");
  EXPECT_EQ(info["warnings"][0], "the finger slipped");
  EXPECT_EQ(info["also"][0], oak_ + ".texture.json");
  const nlohmann::json& channel = info["channels"][0];  // 1, -1, -3, -1 N
  EXPECT_EQ(channel["min"], -3);
  EXPECT_EQ(channel["max"], 1);
  EXPECT_EQ(channel["mean"], -1);
  EXPECT_DOUBLE_EQ(channel["rms"].get<double>(), std::sqrt(3));
  EXPECT_EQ(channel["calibrated"], "2024-02-03");
}

TEST_F(InfoValidate, DescribesATexture) {
  const nlohmann::json info = json({"info", oak_ + ".texture.wav"});
  EXPECT_EQ(info["kind"], "texture");
  EXPECT_EQ(info["pitch_m"], 2e-6);
  EXPECT_DOUBLE_EQ(info["length_m"].get<double>(), 8e-6);
  EXPECT_EQ(info["direction"], 1);
  EXPECT_DOUBLE_EQ(info["rms_n"].get<double>(), std::sqrt(59.0 / 5));
  EXPECT_EQ(info["band_low_per_m"], 300);
  EXPECT_EQ(info["band_high_per_m"], 8000);
  EXPECT_EQ(info["widest_band_low_per_m"], 200);
  EXPECT_EQ(info["widest_band_high_per_m"], 9000);
}

TEST_F(InfoValidate, DescribesATransducer) {
  const nlohmann::json info = json({"info", "wiertlewski2011"});
  EXPECT_NEAR(info["resonance_hz"].get<double>(), 547.7, 0.05);
  EXPECT_NEAR(info["actuator_gain_at_0hz_m_per_v"].get<double>(), 20e-6, 1e-17);
  EXPECT_NEAR(info["sensor_gain_at_100hz_v_per_n"].get<double>(), 26, 1e-11);
}

TEST_F(InfoValidate, DescribesASpectrogram) {
  Spectrogram s;
  s.position_m = {5e-3, 6e-3};
  s.bins = 2;
  s.frequency_step_per_m = 250;
  s.cells = {1, 2, 4, 3};
  s.window = "blackman";
  s.window_m = 10e-3;
  s.hop_m = 1e-3;
  s.pitch_m = 1e-6;
  s.unit = "N";
  ASSERT_TRUE(write_spectrogram_nc(oak_ + ".nc", std::span(&s, 1)));
  const nlohmann::json info = json({"info", oak_ + ".nc"});
  EXPECT_EQ(info["kind"], "spectrogram");
  EXPECT_DOUBLE_EQ(info["peak_position_m"].get<double>(), 6e-3);
  EXPECT_EQ(info["peak_frequency_per_m"], 0);
  EXPECT_DOUBLE_EQ(info["max_frequency_per_m"].get<double>(), 250);
}

TEST_F(InfoValidate, DescribesSeveral) {
  const nlohmann::json info = json({"info", oak_ + ".json", oak_ + ".texture.json", "wiertlewski2011"});
  ASSERT_EQ(info["files"].size(), 3u);
  EXPECT_EQ(info["files"][1]["kind"], "texture");
  const Outcome people = run({"info", oak_ + ".json", "wiertlewski2011"});
  EXPECT_NE(people.out.find("resonance             547.7 Hz"), std::string::npos) << people.out;
  EXPECT_NE(people.out.find("tangential_force  tangential_force  N"), std::string::npos) << people.out;
}

TEST_F(InfoValidate, ZeroHasNoSign) {
  Texture texture;
  texture.signal.pitch_m = 1e-6;
  texture.signal.values = {1, 2};
  texture.source_origin_m = -0.0;
  ASSERT_TRUE(write_texture(folder_ / "zero", texture));
  EXPECT_EQ(run({"info", folder_ / "zero"}).out.find(" -0 "), std::string::npos);
}

TEST_F(InfoValidate, SaysWhatIsNotThere) {
  const Outcome outcome = run({"info", folder_ / "ash"});
  EXPECT_EQ(outcome.exit_code, exit_code(ErrorKind::not_found));
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
}

TEST_F(InfoValidate, WarnsOfANewerMinorVersion) {
  std::string text = read_file(oak_ + ".texture.json").value();
  text.replace(text.find("1.0"), 3, "1.9");
  PendingFiles pending;
  ASSERT_TRUE(pending.write(oak_ + ".texture.json", text));
  ASSERT_TRUE(pending.commit());
  for (const char* verb : {"info", "validate"}) {
    const Outcome outcome = run({verb, oak_ + ".texture.json"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_NE(outcome.err.find("version 1.9"), std::string::npos) << outcome.err;
  }
}

TEST_F(InfoValidate, ValidatesAllUnderAStem) {
  const nlohmann::json report = json({"validate", oak_});
  EXPECT_EQ(report["valid"], true);
  EXPECT_EQ(report["files"].size(), 2u);
  EXPECT_NE(run({"validate", oak_}).out.find("valid  yes"), std::string::npos);
}

TEST_F(InfoValidate, ListsFaultsAndEndsAsMalformed) {
  std::filesystem::resize_file(oak_ + ".texture.wav", 10);
  PendingFiles pending;
  ASSERT_TRUE(
      pending.write(oak_ + ".json", R"({"kind": "recording", "version": "1.0", "sample_rate_hz": -1})"));
  ASSERT_TRUE(pending.commit());
  const Outcome outcome = run({"validate", "--json", oak_});
  EXPECT_EQ(outcome.exit_code, exit_code(ErrorKind::malformed));
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(report["valid"], false);
  std::string places;
  for (const nlohmann::json& fault : report["faults"]) places += fault["where"].get<std::string>() + "\n";
  EXPECT_NE(places.find("oak.json#/sample_rate_hz"), std::string::npos) << places;
  EXPECT_NE(places.find("oak.texture.wav"), std::string::npos) << places;
}

TEST_F(InfoValidate, ChecksEachFileOfAFolder) {
  PendingFiles pending;
  for (const char* other :
       {"notes.txt", "list.json", "sub/sound.wav", ".hidden/torn.texture.json", "ground.height.nc"})
    ASSERT_TRUE(pending.write(folder_ / other, "[1, 2]"));
  Transducer transducer = read_transducer("wiertlewski2011").value();
  ASSERT_TRUE(write_transducer(folder_ / "sub/bench", transducer));
  ASSERT_TRUE(pending.commit());
  const nlohmann::json report = json({"validate", folder_ / ""});
  EXPECT_EQ(report["valid"], true) << report;
  EXPECT_EQ(report["checked"], 3);
  EXPECT_EQ(report["invalid"], 0);
  EXPECT_EQ(report["of_other_programs"], 4);

  ASSERT_TRUE(pending.write(folder_ / "sub/torn.texture.json", "{"));
  ASSERT_TRUE(pending.write(folder_ / "open.events.jsonl", "{}"));
  ASSERT_TRUE(pending.commit());
  std::filesystem::resize_file(oak_ + ".wav", 10);
  const Outcome outcome = run({"validate", "--json", folder_ / ""});
  EXPECT_NE(outcome.exit_code, 0);
  const nlohmann::json faulty = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(faulty["checked"], 5);
  EXPECT_EQ(faulty["invalid"], 3) << faulty;
  std::string invalid;
  for (const nlohmann::json& file : faulty["files"])
    if (!file["valid"]) invalid += file["file"].get<std::string>() + "\n";
  EXPECT_EQ(invalid, (folder_ / "oak.json") + "\n" + (folder_ / "open") + "\n" +
                         (folder_ / "sub/torn.texture.json") + "\n");
}

TEST_F(InfoValidate, AFolderWithoutAFileIsAFault) {
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_EQ(run({"validate", folder_ / "empty"}).exit_code, exit_code(ErrorKind::not_found));
}

TEST_F(InfoValidate, FilesOfOthersAreFaults) {
  PendingFiles pending;
  ASSERT_TRUE(pending.write(folder_ / "list.json", "[1, 2]"));
  ASSERT_TRUE(pending.write(folder_ / "notes.txt", "text"));
  ASSERT_TRUE(pending.commit());
  for (const char* name : {"list.json", "notes.txt"})
    EXPECT_EQ(run({"validate", folder_ / name}).exit_code, exit_code(ErrorKind::malformed)) << name;
}

}  // namespace
}  // namespace tacto::schema
