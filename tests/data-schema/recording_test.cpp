// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings: they read back as written, and faults are reported.
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/recording_frames.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "data-schema/files/files.hpp"
#include "data-schema/version.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

using tests::TemporaryFolder;

Channel force_channel() {
  Channel channel;
  channel.name = "tangential_force";
  channel.quantity = "tangential_force";
  channel.unit = "N";
  channel.scale = 4.0 / 9;
  channel.offset = -0.125;
  channel.range_min = -5;
  channel.range_max = 4.5;
  channel.source = "lateral_V";
  channel.calibrated = "2024-02-29";
  return channel;
}

Channel position_channel() {
  Channel channel;
  channel.name = "position";
  channel.quantity = "position";
  channel.unit = "m";
  channel.scale = 0.5e-6;
  channel.native_rate_hz = 2000;
  channel.derivation = "nominal, 40 mm/s";
  return channel;
}

RecordingHeader full_header(SampleFormat format) {
  RecordingHeader header;
  header.format = format;
  header.sample_rate_hz = 10000;
  header.channels = {force_channel(), position_channel()};
  header.clock = "device";
  header.device = "sim:surface=C";
  header.simulated = "a test";
  header.transducer = read_transducer("wiertlewski2011").value();
  header.subject = "S01";
  header.notes = "d\u00e9j\u00e0 vu";
  header.humidity_percent = 41.5;
  header.marks = {{2, "touch"}};
  header.warnings = {"the finger was cold"};
  return header;
}

template <class Sample>
Recording write(const std::string& name, RecordingHeader header, const std::vector<Sample>& samples,
                bool replace = false) {
  auto writer = RecordingWriter::create(name, std::move(header), replace);
  EXPECT_TRUE(writer) << message(writer.error());
  EXPECT_TRUE(writer->write(std::span<const Sample>(samples)));
  auto recording = writer->close();
  EXPECT_TRUE(recording) << message(recording.error());
  return *recording;
}

const std::vector<double> kSamples = {0.1, 1, 1e-300, 2, -4.0 / 9, 3, 5, 4};

Recording write_simple(const std::string& name) {
  return write(name, full_header(SampleFormat::float64), kSamples);
}

void edit(const std::string& path, const std::string& pointer, const nlohmann::ordered_json& value) {
  nlohmann::ordered_json document = nlohmann::ordered_json::parse(read_file(path).value());
  document["data"].erase("numbers_sha256");  // the fault to be found is another one
  document[nlohmann::ordered_json::json_pointer(pointer)] = value;
  std::ofstream(path) << document.dump(2);
}

void expect_same(const Channel& a, const Channel& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.quantity, b.quantity);
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.scale, b.scale);
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.native_rate_hz, b.native_rate_hz);
  EXPECT_EQ(a.range_min, b.range_min);
  EXPECT_EQ(a.range_max, b.range_max);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.derivation, b.derivation);
  EXPECT_EQ(a.calibrated, b.calibrated);
}

void expect_same(const RecordingHeader& a, const RecordingHeader& b) {
  EXPECT_EQ(a.format, b.format);
  EXPECT_EQ(a.sample_rate_hz, b.sample_rate_hz);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t i = 0; i < a.channels.size(); ++i) expect_same(a.channels[i], b.channels[i]);
  EXPECT_EQ(a.clock, b.clock);
  EXPECT_EQ(a.device, b.device);
  EXPECT_EQ(a.simulated, b.simulated);
  ASSERT_TRUE(a.transducer && b.transducer);
  EXPECT_EQ(a.transducer->actuator_scale, b.transducer->actuator_scale);
  EXPECT_EQ(a.transducer->slew_limit_v_per_s, b.transducer->slew_limit_v_per_s);
  EXPECT_EQ(a.subject, b.subject);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(a.humidity_percent, b.humidity_percent);
  ASSERT_EQ(a.marks.size(), b.marks.size());
  EXPECT_EQ(a.marks[0].frame, b.marks[0].frame);
  EXPECT_EQ(a.marks[0].label, b.marks[0].label);
  EXPECT_EQ(a.warnings, b.warnings);
}

TEST(Recording, GivesImportedNumbersBackToTheBit) {
  const TemporaryFolder folder;
  write_simple(folder / "oak");
  EXPECT_EQ(folder.files(), 2U);
  for (const char* name : {"oak", "oak.json", "oak.wav"}) {
    const auto recording = open_recording(folder / name);
    ASSERT_TRUE(recording) << message(recording.error());
    expect_same(recording->header, full_header(SampleFormat::float64));
    EXPECT_EQ(recording->header.frames, 4U);
    EXPECT_EQ(recording->header.creator, kCreator);
    EXPECT_EQ(recording->header.sha256, sha256_of_file(folder / "oak.wav").value());
    EXPECT_EQ(read_stored(*recording, 0).value(), (std::vector<double>{0.1, 1e-300, -4.0 / 9, 5}));
  }
}

TEST(Recording, GivesConverterCodesBackToTheBit) {
  const TemporaryFolder folder;
  constexpr std::int32_t kTop = std::numeric_limits<std::int32_t>::max();
  const std::vector<std::int32_t> codes = {kTop, 0, -kTop - 1, 1, 1 << 16, -2, -1, 3};
  write(folder / "oak", full_header(SampleFormat::pcm32), codes);
  const auto recording = open_recording(folder / "oak");
  ASSERT_TRUE(recording) << message(recording.error());
  expect_same(recording->header, full_header(SampleFormat::pcm32));
  EXPECT_EQ(read_stored(*recording, 0).value(), (std::vector<double>{kTop, -2147483648.0, 65536, -1}));
  EXPECT_EQ(read_stored(*recording, 1).value(), (std::vector<double>{0, 1, -2, 3}));
}

TEST(Recording, BecomesPhysicalByScaleAndOffset) {
  const TemporaryFolder folder;
  const Recording recording = write_simple(folder / "oak");
  const auto channel = find_channel(recording.header, "tangential_force");
  const TimeSignal force = read_channel(recording, channel.value()).value();
  EXPECT_EQ(force.sample_rate_hz, 10000);
  EXPECT_DOUBLE_EQ(force.values[3], 5 * 4.0 / 9 - 0.125);
  const auto absent = find_channel(recording.header, "taste");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().remedy, "its channels are: tangential_force, position");
}

TEST(Recording, IsLongerThanOnePieceOfReading) {
  const TemporaryFolder folder;
  std::vector<double> samples(2 * 200001);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<double>(i);
  const Recording recording = write(folder / "oak", full_header(SampleFormat::float64), samples);
  const auto position = read_stored(recording, 1).value();
  ASSERT_EQ(position.size(), 200001U);
  for (std::size_t i = 0; i < position.size(); ++i) ASSERT_EQ(position[i], static_cast<double>(2 * i + 1));
}

TEST(Recording, IsReadFromAnyPlace) {
  const TemporaryFolder folder;
  std::vector<double> samples(2 * 100001);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<double>(i);
  const Recording recording = write(folder / "oak", full_header(SampleFormat::float64), samples);
  auto frames = RecordingFrames::open(recording);
  ASSERT_TRUE(frames) << message(frames.error());
  const Channel& force = recording.header.channels[0];
  for (const std::size_t first : {std::size_t{0}, std::size_t{99000}, std::size_t{5}, std::size_t{1005}}) {
    std::vector<double> stored(1000), physical(1000);
    ASSERT_TRUE(frames->read_stored(1, first, stored));
    ASSERT_TRUE(frames->read(0, first, physical));
    for (std::size_t i = 0; i < 1000; ++i) {
      ASSERT_EQ(stored[i], static_cast<double>(2 * (first + i) + 1));
      ASSERT_EQ(physical[i], static_cast<double>(2 * (first + i)) * force.scale + force.offset);
    }
  }
  std::vector<double> all(100001);
  ASSERT_TRUE(frames->read_stored(0, 0, all));  // longer than a piece of reading
  EXPECT_EQ(all, read_stored(recording, 0).value());
}

TEST(Recording, ReadFromAnyPlaceNamesTheSampleThatIsNotFinite) {
  const TemporaryFolder folder;
  auto samples = kSamples;
  samples[5] = std::numeric_limits<double>::quiet_NaN();
  const Recording recording = write(folder / "oak", full_header(SampleFormat::float64), samples, true);
  auto frames = RecordingFrames::open(recording);
  ASSERT_TRUE(frames);
  std::vector<double> out(3);
  ASSERT_TRUE(frames->read_stored(0, 1, out));
  const auto broken = frames->read_stored(1, 1, out);
  ASSERT_FALSE(broken);
  EXPECT_NE(message(broken.error()).find("sample 2"), std::string::npos);
  ASSERT_TRUE(frames->read_stored(1, 0, std::span(out).first(2)));  // the data before it are read
}

TEST(Recording, NamesTheSampleThatIsNotFinite) {
  const TemporaryFolder folder;
  for (const double broken :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    auto samples = kSamples;
    samples[5] = broken;
    const Recording recording = write(folder / "oak", full_header(SampleFormat::float64), samples, true);
    EXPECT_TRUE(read_channel(recording, 0));
    const auto position = read_channel(recording, 1);
    ASSERT_FALSE(position);
    EXPECT_EQ(position.error().kind, ErrorKind::malformed);
    EXPECT_NE(position.error().what.find("sample 2"), std::string::npos) << message(position.error());
  }
}

TEST(Recording, AGapThatIsThereTwiceIsRefused) {
  const TemporaryFolder folder;
  auto writer = RecordingWriter::create(folder / "oak", full_header(SampleFormat::float64)).value();
  ASSERT_TRUE(writer.write(std::span(kSamples)));
  writer.header().gaps = {{2, 7, 5}, {2, 7, 5}};
  const auto closed = writer.close();
  ASSERT_FALSE(closed);
  EXPECT_EQ(closed.error().where, "/gaps/1/device_sequence");
}

TEST(Recording, CountsGapsInTheTime) {
  const TemporaryFolder folder;
  RecordingHeader header = full_header(SampleFormat::float64);
  auto writer = RecordingWriter::create(folder / "oak", header).value();
  ASSERT_TRUE(writer.write(std::span(kSamples)));
  writer.header().gaps = {{0, 0, 5}, {2, 7, 100}, {2, 107, 1}, {4, 110, 7}};
  ASSERT_TRUE(writer.close());
  const auto recording = open_recording(folder / "oak");
  ASSERT_TRUE(recording) << message(recording.error());
  ASSERT_EQ(recording->header.gaps.size(), 4U);
  EXPECT_EQ(recording->header.gaps[1].device_sequence, 7U);
  const std::size_t frames_before[] = {5, 6, 108, 109, 117};
  for (std::uint64_t frame = 0; frame < 5; ++frame)
    EXPECT_DOUBLE_EQ(frame_time_s(recording->header, frame),
                     static_cast<double>(frames_before[frame]) / 10000);
  EXPECT_DOUBLE_EQ(read_channel(*recording, 0)->start_s, 5e-4);
}

TEST(Recording, SaysWhatIsLeftOfATruncatedWav) {
  const TemporaryFolder folder;
  write_simple(folder / "oak");
  const auto size = std::filesystem::file_size(folder / "oak.wav");
  std::filesystem::resize_file(folder / "oak.wav", size - 24);  // 16 bytes a frame
  const auto cut = open_recording(folder / "oak");
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().kind, ErrorKind::malformed);
  EXPECT_EQ(cut.error().where, folder / "oak.wav");
  edit(folder / "oak.json", "/data/frames", 9);
  write(folder / "elm", full_header(SampleFormat::float64), kSamples);
  std::filesystem::rename(folder / "elm.wav", folder / "oak.wav");
  EXPECT_EQ(open_recording(folder / "oak").error().what, "truncated: its sidecar has 9 frames, the file 4");
  edit(folder / "oak.json", "/data/frames", 3);
  EXPECT_EQ(open_recording(folder / "oak").error().what, "has 4 frames, its sidecar 3");
  std::filesystem::remove(folder / "oak.wav");
  EXPECT_EQ(open_recording(folder / "oak").error().kind, ErrorKind::not_found);
}

TEST(Recording, RefusesSidecarsThatContradictTheWav) {
  const TemporaryFolder folder;
  write_simple(folder / "oak");
  const nlohmann::ordered_json sound = nlohmann::ordered_json::parse(read_file(folder / "oak.json").value());
  const std::pair<const char*, nlohmann::ordered_json> lies[] = {
      {"/sample_rate_hz", 9000},
      {"/data/format", "pcm32"},
      {"/channels", nlohmann::ordered_json::array({sound["channels"][0]})}};
  for (const auto& [pointer, lie] : lies) {
    std::ofstream(folder / "oak.json") << sound;
    edit(folder / "oak.json", pointer, lie);
    EXPECT_EQ(open_recording(folder / "oak").error().kind, ErrorKind::malformed) << pointer;
  }
}

TEST(Recording, RefusesBySchemaAndBeyond) {
  const TemporaryFolder folder;
  write_simple(folder / "oak");
  const std::string path = folder / "oak.json";
  const nlohmann::ordered_json sound = nlohmann::ordered_json::parse(read_file(path).value());
  const std::pair<const char*, nlohmann::ordered_json> breaches[] = {{"/channels/1/unit", "kg"},
                                                                     {"/channels/1/unit", "N"},
                                                                     {"/channels/1/name", "tangential_force"},
                                                                     {"/transducer/mass_kg", -1},
                                                                     {"/data/sha256", "abc"}};
  for (const auto& [pointer, value] : breaches) {
    std::ofstream(path) << sound;
    edit(path, pointer, value);
    const auto recording = open_recording(path);
    ASSERT_FALSE(recording) << pointer;
    EXPECT_EQ(recording.error().where, path + "#" + pointer);
  }
}

TEST(Recording, FromTheFutureIsRefusedByMajorAndKeptByMinor) {
  const TemporaryFolder folder;
  write_simple(folder / "oak");
  edit(folder / "oak.json", "/version", "2.0");
  EXPECT_EQ(open_recording(folder / "oak").error().kind, ErrorKind::unsupported_version);
  edit(folder / "oak.json", "/version", "1.3");
  edit(folder / "oak.json", "/aroma", {{"note", "resin"}});
  const auto newer = open_recording(folder / "oak");
  ASSERT_TRUE(newer) << message(newer.error());
  EXPECT_EQ(newer->header.newer_version, "1.3");
  write(folder / "copy", newer->header, kSamples);
  EXPECT_EQ(nlohmann::ordered_json::parse(read_file(folder / "copy.json").value())["aroma"],
            nlohmann::ordered_json({{"note", "resin"}}));
}

TEST(Recording, SaysWhatElseTheNameStandsFor) {
  const TemporaryFolder folder;
  EXPECT_EQ(open_recording(folder / "oak").error().kind, ErrorKind::not_found);
  write_simple(folder / "oak");
  edit(folder / "oak.json", "/kind", "texture");
  EXPECT_EQ(open_recording(folder / "oak").error().what, "its kind is 'texture', not 'recording'");
  std::filesystem::remove(folder / "oak.json");
  for (const char* name : {"oak", "oak.wav"}) {
    const auto plain = open_recording(folder / name);
    ASSERT_FALSE(plain);
    EXPECT_EQ(plain.error().kind, ErrorKind::unsuitable);
    EXPECT_NE(plain.error().remedy.find("import"), std::string::npos);
  }
}

TEST(RecordingWriter, LeavesNothingWhenDropped) {
  const TemporaryFolder folder;
  {
    auto writer = RecordingWriter::create(folder / "oak", full_header(SampleFormat::float64));
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->write(std::span(kSamples)));
    EXPECT_FALSE(std::filesystem::exists(folder / "oak.wav"));
  }
  EXPECT_EQ(folder.files(), 0U);
}

TEST(RecordingWriter, OverwritesOnlyWhenToldTo) {
  const TemporaryFolder folder;
  write_simple(folder / "oak");
  const auto refused = RecordingWriter::create(folder / "oak", full_header(SampleFormat::float64));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::usage);
  write(folder / "oak.wav", full_header(SampleFormat::float64), std::vector<double>{1, 2}, true);
  EXPECT_EQ(open_recording(folder / "oak")->header.frames, 1U);
  EXPECT_EQ(folder.files(), 2U);
}

TEST(RecordingWriter, RefusesHeadersThatCantBeStoredBeforeItWrites) {
  const TemporaryFolder folder;
  std::vector<RecordingHeader> headers(6, full_header(SampleFormat::float64));
  headers[0].channels[1].name = "tangential_force";
  headers[1].channels[1].unit = "N";
  headers[2].channels.clear();
  headers[3].channels[0].scale = std::numeric_limits<double>::infinity();
  headers[4].sample_rate_hz = 0;
  headers[5].format = SampleFormat::float32;
  for (const RecordingHeader& header : headers) {
    const auto writer = RecordingWriter::create(folder / "oak", header);
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().kind, ErrorKind::unsuitable) << message(writer.error());
    EXPECT_TRUE(writer.error().where.starts_with("/")) << message(writer.error());
  }
  EXPECT_EQ(RecordingWriter::create("/proc/absent/oak", full_header(SampleFormat::float64)).error().kind,
            ErrorKind::cannot_write);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(RecordingWriter, GivesEqualFilesForEqualInput) {
  const TemporaryFolder folder;
  setenv("SOURCE_DATE_EPOCH", "1709210096", 1);
  write_simple(folder / "oak");
  const std::string wav = read_file(folder / "oak.wav").value();
  const std::string json = read_file(folder / "oak.json").value();
  std::filesystem::remove(folder / "oak.wav");
  std::filesystem::remove(folder / "oak.json");
  const Recording again = write_simple(folder / "oak");
  unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_EQ(read_file(folder / "oak.wav").value(), wav);
  EXPECT_EQ(read_file(folder / "oak.json").value(), json);
  EXPECT_EQ(again.header.created, "2024-02-29T12:34:56Z");
}

}  // namespace
}  // namespace tacto::schema
