// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/record.hpp"
#include "firmware-host/open_device.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::capture {
namespace {

using firmware_host::Capabilities;
using firmware_host::StreamCounts;
using schema::ErrorKind;
using tests::TemporaryFolder;

schema::Channel channel(const std::string& quantity, const std::string& unit, double scale) {
  schema::Channel result;
  result.name = result.quantity = quantity;
  result.unit = unit;
  result.scale = scale;
  return result;
}

// Two channels that count up at 1 kHz, in small pieces; ends, or fails, after `length` frames.
class CountingDevice final : public firmware_host::Device {
 public:
  explicit CountingDevice(std::uint64_t length, bool fails = false) : length_(length), fails_(fails) {
    capabilities_.uri = "test:counting";
    capabilities_.clock = "device";
    capabilities_.sample_rate_hz = 1000;
    capabilities_.transducer = *schema::read_transducer("wiertlewski2011");
    capabilities_.channels = {channel("tangential_force", "V", 10 / 0x1p31), channel("position", "m", 1e-6)};
  }

  Capabilities& can() { return capabilities_; }
  void lose_after(std::uint64_t frames, std::uint64_t lost) {
    lose_at_ = frames;
    lose_ = lost;
  }
  const Capabilities& capabilities() const override { return capabilities_; }
  schema::Result<void> start() override {
    counts_ = {};
    return {};
  }
  schema::Result<std::size_t> read(std::span<std::int32_t> interleaved) override {
    if (fails_ && counts_.frames == length_)
      return schema::fail(ErrorKind::device, "unplugged", capabilities_.uri);
    const std::size_t frames = std::min<std::size_t>({interleaved.size() / 2, length_ - counts_.frames, 300});
    if (counts_.frames == lose_at_) counts_.lost_frames = lose_;
    for (std::size_t i = 0; i < frames; ++i, ++counts_.frames) {
      interleaved[2 * i] = static_cast<std::int32_t>(counts_.frames) << 16;
      interleaved[2 * i + 1] = -static_cast<std::int32_t>(counts_.frames);
    }
    return frames;
  }
  schema::Result<void> stop() override {
    ++stops;
    return {};
  }
  StreamCounts counts() const override { return counts_; }

  int stops = 0;

 private:
  Capabilities capabilities_;
  std::uint64_t length_;
  bool fails_;
  std::uint64_t lose_at_ = std::numeric_limits<std::uint64_t>::max(), lose_ = 0;
  StreamCounts counts_;
};

RecordRequest request(const std::string& name, double time_s) {
  RecordRequest result;
  result.name = name;
  result.time_s = time_s;
  return result;
}

TEST(Record, WritesTheCodesAsTheyCame) {
  const TemporaryFolder folder;
  CountingDevice device(1U << 30);
  const auto recorded = record(device, request(folder / "oak", 2.5));
  ASSERT_TRUE(recorded) << message(recorded.error());
  EXPECT_EQ(device.stops, 1);
  const auto opened = schema::open_recording(folder / "oak");
  ASSERT_TRUE(opened) << message(opened.error());
  EXPECT_EQ(opened->header.format, schema::SampleFormat::pcm32);
  ASSERT_EQ(opened->header.frames, 2500U);
  const auto codes = schema::read_stored(*opened, 0), counts = schema::read_stored(*opened, 1);
  for (std::size_t i = 0; i < 2500; ++i) {
    ASSERT_EQ((*codes)[i], static_cast<double>(i) * 65536);
    ASSERT_EQ((*counts)[i], -static_cast<double>(i));
  }
}

// 26 V/N: 10 V are 0.385 N of the opposite sign, because the sensor's gain is negative.
TEST(Record, ReadsVoltsAsNominalNewtonsAndSaysSo) {
  const TemporaryFolder folder;
  CountingDevice device(2000);
  device.can().channels[0].range_min = -10;
  device.can().channels[0].range_max = 9.9;
  const auto recorded = record(device, request(folder / "oak", 2));
  ASSERT_TRUE(recorded);
  const schema::Channel& force = recorded->recording.header.channels[0];
  EXPECT_EQ(force.unit, "N");
  EXPECT_NEAR(force.scale, -10 / 0x1p31 / 26, 1e-3 * 10 / 0x1p31 / 26);
  EXPECT_NEAR(*force.range_max, 10.0 / 26, 1e-3);
  EXPECT_NEAR(*force.range_min, -9.9 / 26, 1e-3);
  EXPECT_NE(force.derivation.find("not flat"), std::string::npos);
  EXPECT_NEAR(recorded->statistics[0].min(), -1999 * 65536 * 10 / 0x1p31 / 26, 1e-3);
  EXPECT_DOUBLE_EQ(recorded->statistics[1].min(), -1999e-6);
}

TEST(Record, KeepsWhatTheDeviceAndTheUserSay) {
  const TemporaryFolder folder;
  CountingDevice device(1000);
  device.can().simulated = "by a test";
  device.can().surface = "glass";
  RecordRequest asked = request(folder / "oak", 1);
  asked.subject = "S01", asked.finger = "index", asked.notes = "dry";
  ASSERT_TRUE(record(device, asked));
  const auto header = schema::open_recording(folder / "oak")->header;
  EXPECT_EQ(header.device, "test:counting");
  EXPECT_EQ(header.simulated, "by a test");
  EXPECT_EQ(header.clock, "device");
  EXPECT_EQ(header.surface, "glass");
  EXPECT_EQ(header.subject, "S01");
  EXPECT_EQ(header.finger, "index");
  EXPECT_EQ(header.notes, "dry");
  EXPECT_EQ(header.transducer->name, "wiertlewski2011");
  EXPECT_TRUE(header.warnings.empty());
}

TEST(Record, WhatTheUserCallsTheSurfaceComesFirst) {
  const TemporaryFolder folder;
  CountingDevice device(1000);
  device.can().surface = "glass";
  RecordRequest asked = request(folder / "oak", 1);
  asked.surface = "oak, planed";
  EXPECT_EQ(record(device, asked)->recording.header.surface, "oak, planed");
}

TEST(Record, NeverOverwrites) {
  const TemporaryFolder folder;
  CountingDevice first(1000), second(1000);
  const auto kept = record(first, request(folder / "oak", 0.5));
  ASSERT_TRUE(kept);
  const auto refused = record(second, request(folder / "oak", 1));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::usage);
  EXPECT_EQ(schema::open_recording(folder / "oak")->header.sha256, kept->recording.header.sha256);
}

TEST(Record, RefusesATimeThatIsNone) {
  const TemporaryFolder folder;
  CountingDevice device(1000);
  for (const double time_s : {0.0, -1.0, 1e-9, std::numeric_limits<double>::quiet_NaN()}) {
    const auto refused = record(device, request(folder / "oak", time_s));
    ASSERT_FALSE(refused) << time_s;
    EXPECT_EQ(refused.error().kind, ErrorKind::usage);
  }
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Record, ADeviceThatFailsClosesTheRecordingWithTheReason) {
  const TemporaryFolder folder;
  CountingDevice device(500, true);
  const auto recorded = record(device, request(folder / "oak", 1));
  ASSERT_TRUE(recorded) << message(recorded.error());
  ASSERT_TRUE(recorded->ended_by);
  EXPECT_EQ(recorded->ended_by->what, "unplugged");
  EXPECT_EQ(device.stops, 1);
  const auto opened = schema::open_recording(folder / "oak");
  ASSERT_TRUE(opened) << message(opened.error());
  EXPECT_EQ(opened->header.frames, 500U);
  EXPECT_EQ(opened->header.ended, "unplugged");
  EXPECT_EQ(folder.files(), 2U);
}

TEST(Record, ADeviceThatFailsBeforeItsFirstFrameLeavesNothing) {
  const TemporaryFolder folder;
  CountingDevice device(0, true);
  EXPECT_EQ(record(device, request(folder / "oak", 1)).error().what, "unplugged");
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Record, LostFramesAreAGapWhereTheyWereLost) {
  for (const std::uint64_t lost : {1, 25}) {
    const TemporaryFolder folder;
    CountingDevice device(2000);
    device.lose_after(300, lost);
    const auto recorded = record(device, request(folder / "oak", 1));
    ASSERT_TRUE(recorded);
    const auto& gaps = recorded->recording.header.gaps;
    ASSERT_EQ(gaps.size(), 1U) << lost;
    EXPECT_EQ(gaps[0].frame, 300U);
    EXPECT_EQ(gaps[0].device_sequence, 300 + lost);
    EXPECT_EQ(gaps[0].count, lost);
    EXPECT_TRUE(recorded->recording.header.warnings.at(0).starts_with(fmt::format("{} frames", lost)));
  }
}

TEST(Record, StopsAndMarksWhenAsked) {
  const TemporaryFolder folder;
  CountingDevice device(1U << 30);
  RecordRequest asked = request(folder / "oak", 1);
  asked.time_s.reset();
  int blocks = 0;
  RecordHooks hooks;
  hooks.stop = [&] { return blocks == 10; };
  hooks.new_marks = [&] { return std::vector<std::string>(++blocks == 4 ? 2U : 0U, "mark"); };
  std::vector<double> times_s;
  hooks.marked = [&](const schema::Mark& mark, double time_s) {
    EXPECT_EQ(mark.label, "mark");
    times_s.push_back(time_s);
  };
  const auto recorded = record(device, asked, hooks);
  ASSERT_TRUE(recorded);
  EXPECT_EQ(recorded->recording.header.frames, 200U);  // ten blocks of 20 ms at 1 kHz
  ASSERT_EQ(recorded->recording.header.marks.size(), 2U);
  EXPECT_EQ(recorded->recording.header.marks[1].frame, 80U);
  EXPECT_EQ(times_s, std::vector<double>(2, 0.08));
  EXPECT_EQ(recorded->recording.header.ended, "");
}

// The keys m and q may be read together: the mark is asked for when the recording ends already.
TEST(Record, KeepsAMarkThatComesTogetherWithTheEnd) {
  const TemporaryFolder folder;
  CountingDevice device(1U << 30);
  RecordRequest asked = request(folder / "oak", 1);
  asked.time_s.reset();
  int blocks = 0;
  bool ended = false;
  RecordHooks hooks;
  hooks.stop = [&] { return ended = blocks == 10; };
  hooks.new_marks = [&] { return ++blocks, std::vector<std::string>(ended ? 1U : 0U, "mark"); };
  const auto recorded = record(device, asked, hooks);
  ASSERT_TRUE(recorded);
  ASSERT_EQ(recorded->recording.header.marks.size(), 1U);
  EXPECT_EQ(recorded->recording.header.marks[0].frame, recorded->recording.header.frames);
}

TEST(Record, EndsAfterTheStrokesThatWereAskedFor) {
  const TemporaryFolder folder;
  const auto device = firmware_host::open_device("sim:surface=flat,strokes=6");
  RecordRequest asked = request(folder / "oak", 20);
  asked.strokes = 3;
  const auto recorded = record(**device, asked);
  ASSERT_TRUE(recorded);
  const auto& strokes = recorded->recording.header.strokes;
  ASSERT_EQ(strokes.size(), 3U);
  EXPECT_LT(recorded->recording.header.frames, 40000U);  // 0.9 s a stroke
  for (const schema::StrokeFigures& stroke : strokes) {
    EXPECT_NEAR(stroke.mean_speed_mps, 0.05, 0.015);
    EXPECT_NEAR(stroke.mean_normal_n.value_or(0), 0.5, 0.25);
    EXPECT_GT(stroke.length_m, 0.025);
  }
  EXPECT_EQ(strokes[0].direction, -strokes[1].direction);
}

TEST(Record, ATimeThatTheDiskHasNoRoomForIsRefused) {
  const TemporaryFolder folder;
  CountingDevice device(1000);
  const auto refused = record(device, request(folder / "oak", 1e11));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::cannot_write);
  EXPECT_NE(refused.error().what.find("are free"), std::string::npos);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Record, TheViewShowsLevelsAndClipping) {
  const TemporaryFolder folder;
  CountingDevice device(1000);
  device.can().channels[1].range_min = -30e-6;
  std::vector<LiveView> views;
  RecordHooks hooks;
  hooks.view = [&](const LiveView& view, const schema::RecordingHeader&) { views.push_back(view); };
  ASSERT_TRUE(record(device, request(folder / "oak", 1), hooks));
  ASSERT_FALSE(views.empty());
  EXPECT_EQ(views[0].levels.size(), 2U);
  EXPECT_DOUBLE_EQ(views[0].levels[1].smallest, -19e-6);
  EXPECT_FALSE(views[0].levels[1].clipped);
  EXPECT_DOUBLE_EQ(*views[0].speed_mps, 19e-6 / 20 * 1000);
  EXPECT_GT(views[0].disk_left_bytes, 0U);
}

TEST(Record, AStreamThatEndsEarlyIsKeptWithAWarning) {
  const TemporaryFolder folder;
  CountingDevice device(500);
  ASSERT_TRUE(record(device, request(folder / "oak", 1)));
  const auto header = schema::open_recording(folder / "oak")->header;
  EXPECT_EQ(header.frames, 500U);
  ASSERT_EQ(header.warnings.size(), 1U);
  EXPECT_NE(header.warnings[0].find("500 of 1000"), std::string::npos);
}

TEST(Record, AStreamOfNothingIsAnError) {
  const TemporaryFolder folder;
  CountingDevice device(0);
  EXPECT_EQ(record(device, request(folder / "oak", 1)).error().what, "the device sent no frames");
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Record, VoltsWithoutATransducerAreRefused) {
  const TemporaryFolder folder;
  CountingDevice device(500);
  device.can().transducer.reset();
  EXPECT_EQ(record(device, request(folder / "oak", 1)).error().kind, ErrorKind::device);
}

TEST(Record, MakesTheFolderAndRemovesItIfTheDeviceDoesNotStart) {
  const TemporaryFolder folder;
  CountingDevice device(500);
  ASSERT_TRUE(record(device, request(folder / "new/er/oak", 1)));
  EXPECT_TRUE(schema::is_file(folder / "new/er/oak.wav"));
  CountingDevice broken(500);
  broken.can().transducer.reset();
  ASSERT_FALSE(record(broken, request(folder / "none/oak", 1)));
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

TEST(Record, AFolderThatCannotBeMadeIsSaidBeforeTheDeviceStarts) {
  const TemporaryFolder folder;
  CountingDevice device(500);
  const auto refused = record(device, request("/proc/none/oak", 1));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::cannot_write);
  EXPECT_EQ(device.counts().frames, 0U);
}

TEST(Record, ProgressRunsToOne) {
  const TemporaryFolder folder;
  CountingDevice device(2000);
  std::vector<double> heard;
  ASSERT_TRUE(record(device, request(folder / "oak", 2),
                     {[&](double part) { heard.push_back(part); }, {}, {}, {}, {}}));
  EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
  EXPECT_EQ(heard.back(), 1);
}

TEST(Record, TheEmulatedDevicesClippingIsWarnedOf) {
  const TemporaryFolder folder;
  const auto device = firmware_host::open_device("sim:surface=B,load=3N");
  const auto recorded = record(**device, request(folder / "loud", 0.5));
  ASSERT_TRUE(recorded);
  EXPECT_GT(recorded->counts.clipped, 0U);
  ASSERT_FALSE(recorded->recording.header.warnings.empty());
  EXPECT_NE(recorded->recording.header.warnings[0].find("clipped"), std::string::npos);
}

// At 100 Hz nominal newtons are newtons: except for the friction through the high-pass, the load cell's net
// force and the transducer must have the same sign.
TEST(Record, TheForceHasTheSignOfTheFingersPull) {
  const TemporaryFolder folder;
  const auto device = firmware_host::open_device("sim:surface=flat,strokes=1");
  ASSERT_TRUE(record(**device, request(folder / "flat", 0.25)));
  const auto opened = schema::open_recording(folder / "flat");
  const auto force = schema::read_channel(*opened, 0), net = schema::read_channel(*opened, 3);
  double together = 0;
  for (std::size_t i = 1000; i < 1800; ++i)
    together += force->values[i] * net->values[i];  // while the finger starts to move
  EXPECT_GT(together, 0);
}

}  // namespace
}  // namespace tacto::capture
