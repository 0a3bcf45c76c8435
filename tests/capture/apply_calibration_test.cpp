// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/apply_calibration.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <thread>

#include "capture/record/record.hpp"
#include "firmware-host/open_device.hpp"
#include "tests/capture/sim_take.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::capture {
namespace {

using schema::CalibrationEntry;
using schema::CalibrationFile;
using schema::ErrorKind;
using tests::TemporaryFolder;

constexpr const char* kDay = "2026-11-01T12:00:00Z";
constexpr const char* kNow = "2026-11-21T12:00:00Z";

schema::RecordingHeader calibrated_header() {
  schema::RecordingHeader made;
  made.serial = "T-1";
  made.sample_rate_hz = 1000;
  made.channels.resize(1);
  schema::Channel& channel = made.channels[0];
  channel.name = channel.quantity = "normal_force";
  channel.unit = "N";
  channel.scale = 0.01;
  channel.offset = 0.5;
  channel.range_min = -9.5;  // codes -1000 to 1000
  channel.range_max = 10.5;
  return made;
}

CalibrationEntry scale(double value, const std::string& date, double nominal = 0.01) {
  CalibrationEntry entry;
  entry.channel = "normal_force";
  entry.unit = "N";
  entry.method = "weights";
  entry.date = date;
  entry.nominal_scale = nominal;
  entry.scale = value;
  entry.scale_uncertainty = 1e-5;
  return entry;
}

CalibrationEntry tare(double zero, const std::string& date) {
  CalibrationEntry entry = scale(1, date);
  entry.scale.reset();
  entry.scale_uncertainty.reset();
  entry.method = "tare";
  entry.zero = zero;
  entry.zero_uncertainty = 2;
  return entry;
}

TEST(ApplyCalibration, PhysicalIsStoredMinusZeroTimesScale) {
  auto device = calibrated_header();
  CalibrationFile file{"T-1", {}, {}, {scale(0.02, kDay), tare(40, kDay)}, {}, {}};
  const auto warnings = apply_calibration(device, file, kStaleAfter_s, kNow);
  ASSERT_TRUE(warnings);
  EXPECT_TRUE(warnings->empty());
  const schema::Channel& channel = device.channels[0];
  EXPECT_DOUBLE_EQ(channel.scale, 0.02);
  EXPECT_DOUBLE_EQ(channel.offset, -0.8);
  EXPECT_DOUBLE_EQ(*channel.range_max, 1000 * 0.02 - 0.8);
  EXPECT_DOUBLE_EQ(*channel.range_min, -1000 * 0.02 - 0.8);
  EXPECT_EQ(channel.calibrated, "2026-11-01");
  EXPECT_EQ(channel.calibration->nominal_scale, 0.01);
  EXPECT_EQ(channel.calibration->scale_uncertainty, 1e-5);
  EXPECT_DOUBLE_EQ(*channel.calibration->zero_uncertainty, 0.04);
  const schema::Channel back = nominal(channel);
  EXPECT_DOUBLE_EQ(back.scale, 0.01);
  EXPECT_DOUBLE_EQ(back.offset, 0.5);
  EXPECT_DOUBLE_EQ(*back.range_max, 10.5);
}

TEST(ApplyCalibration, TheNewestCountsWhateverItsPlace) {
  auto device = calibrated_header();
  CalibrationFile file{"T-1", {}, {}, {scale(0.03, kDay), scale(0.02, "2026-10-01T00:00:00Z")}, {}, {}};
  ASSERT_TRUE(apply_calibration(device, file, kStaleAfter_s, kNow));
  EXPECT_EQ(device.channels[0].scale, 0.03);
  EXPECT_DOUBLE_EQ(device.channels[0].offset, 1.5);  // the device's own offset in the new scale
}

TEST(ApplyCalibration, AStaleOneIsAppliedAndWarnedOf) {
  auto device = calibrated_header();
  CalibrationFile file{"T-1", {}, {}, {scale(0.02, "2026-10-01T12:00:00Z"), tare(0, kDay)}, {}, {}};
  const auto warnings = apply_calibration(device, file, kStaleAfter_s, kNow);
  ASSERT_EQ(warnings->size(), 1U);
  EXPECT_NE((*warnings)[0].find("2026-10-01, 51 days"), std::string::npos) << (*warnings)[0];
  EXPECT_EQ(device.channels[0].scale, 0.02);
  auto again = calibrated_header();
  EXPECT_TRUE(apply_calibration(again, file, 60 * 86400.0, kNow)->empty());
  auto later = calibrated_header();
  EXPECT_EQ(apply_calibration(later, file, 19 * 86400.0, kNow)->size(), 2U);
}

TEST(ApplyCalibration, OneOfTheFutureIsWarnedOf) {
  auto device = calibrated_header();
  const CalibrationFile file{"T-1", {}, {}, {scale(0.02, "2027-09-21T12:00:00Z")}, {}, {}};
  const auto warnings = apply_calibration(device, file, kStaleAfter_s, kNow);
  ASSERT_EQ(warnings->size(), 1U);
  EXPECT_NE((*warnings)[0].find("2027-09-21, 304 days"), std::string::npos) << (*warnings)[0];
  const CalibrationFile ahead{"T-1", {}, {}, {scale(0.02, "2026-11-21T22:00:00Z")}, {}, {}};
  auto near = calibrated_header();
  EXPECT_TRUE(apply_calibration(near, ahead, kStaleAfter_s, kNow)->empty());
}

TEST(ApplyCalibration, OneOfAnotherScaleOfTheDeviceIsNot) {
  auto device = calibrated_header();
  CalibrationFile file{"T-1", {}, {}, {scale(0.02, kDay, 0.011)}, {}, {}};
  const auto warnings = apply_calibration(device, file, kStaleAfter_s, kNow);
  ASSERT_EQ(warnings->size(), 1U);
  EXPECT_NE((*warnings)[0].find("is not applied"), std::string::npos);
  EXPECT_EQ(device.channels[0].scale, 0.01);
  EXPECT_FALSE(device.channels[0].calibration);
}

TEST(ApplyCalibration, OneOfAnotherDeviceIsRefused) {
  auto device = calibrated_header();
  EXPECT_EQ(apply_calibration(device, {"T-2", {}, {}, {}, {}, {}}, 1, kNow).error().kind,
            ErrorKind::unsuitable);
}

TEST(KeepCalibration, AddsToItsDevicesFile) {
  const TemporaryFolder folder;
  const std::string path = folder / "deep/er/T-1.calibration.json";
  ASSERT_TRUE(keep_calibration(calibrated_header(), "bench", {scale(0.02, "")}, path, kDay));
  ASSERT_TRUE(keep_calibration(calibrated_header(), "bench", {tare(3, "")}, path, kNow));
  const auto file = schema::read_calibration(path);
  ASSERT_TRUE(file) << schema::message(file.error());
  ASSERT_EQ(file->entries.size(), 2U);
  EXPECT_EQ(file->device, "bench");
  EXPECT_EQ(file->entries[0].date, kDay);
  EXPECT_EQ(file->entries[1].date, kNow);
  auto other = calibrated_header();
  other.serial = "T-2";
  EXPECT_EQ(keep_calibration(other, "", {}, path, kNow).error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(schema::read_calibration(path)->entries.size(), 2U);
}

TEST(KeepCalibration, OfSeveralAtOnceLosesNone) {
  const TemporaryFolder folder;
  const std::string path = folder / "new/T-1.calibration.json";
  std::vector<std::thread> people;
  for (int person = 0; person < 4; ++person)
    people.emplace_back([&] {
      for (int i = 0; i < 5; ++i)
        EXPECT_TRUE(keep_calibration(calibrated_header(), "", {tare(3, "")}, path, kNow));
    });
  for (std::thread& person : people) person.join();
  EXPECT_EQ(schema::read_calibration(path)->entries.size(), 20U);
}

TEST(CalibrationOf, IsNoneOnlyWhereNobodyNamedOne) {
  const TemporaryFolder folder;
  setenv("XDG_CONFIG_HOME", (folder / "config").c_str(), 1);
  const auto none = calibration_of("T-1", "");
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
  EXPECT_EQ(calibration_of("T-1", folder / "mine.json").error().kind, ErrorKind::not_found);
  ASSERT_TRUE(keep_calibration(calibrated_header(), "", {tare(3, "")}, "", kNow));
  EXPECT_EQ((*calibration_of("T-1", ""))->entries.size(), 1U);
}

// The whole sequence: an emulated load cell with an error of 5 % and 0.1 N is calibrated by weights; a
// recording applies it.
TEST(ApplyCalibration, ARecordingCarriesIt) {
  const TemporaryFolder folder;
  const auto device =
      firmware_host::open_device("sim:finger=up,weight=1N,cell_gain=1.05,cell_zero=0.1N,noise=off");
  const Take own = *take_from(**device, 0.2);
  CalibrationEntry entry = scale(own.header.channels[2].scale / 1.05, kDay, own.header.channels[2].scale);
  entry.zero = 0.1 / own.header.channels[2].scale;
  RecordRequest request;
  request.name = folder / "weight";
  request.time_s = 0.3;
  request.calibration = CalibrationFile{own.header.serial, {}, {}, {entry}, {}, {}};
  const auto recorded = record(**device, request);
  ASSERT_TRUE(recorded) << schema::message(recorded.error());
  const auto opened = schema::open_recording(folder / "weight");
  ASSERT_TRUE(opened) << schema::message(opened.error());
  EXPECT_NEAR(schema::read_channel(*opened, 2)->values.back(), 1, 1e-3);
  EXPECT_EQ(opened->header.channels[2].calibration->scale_method, "weights");
  EXPECT_EQ(opened->header.serial, "sim-1");
  // The device's own scale can be recovered from that recording, and calibrated again.
  const auto part = take_from(RecordingPart{folder / "weight", 0.1, 0.3});
  ASSERT_TRUE(part) << schema::message(part.error());
  EXPECT_EQ(part->header.channels[2].scale, own.header.channels[2].scale);
  EXPECT_EQ(part->frames(), 2000U);
}

TEST(RecordingPart, IsReadFromItsName) {
  const auto part = parse_recording_part("a@b@1s..2500ms");
  ASSERT_TRUE(part);
  EXPECT_EQ(part->name, "a@b");
  EXPECT_EQ(part->from_s, 1);
  EXPECT_EQ(part->to_s, 2.5);
  EXPECT_EQ(parse_recording_part("oak")->name, "oak");
  for (const char* wrong : {"oak@1s", "oak@1..2", "oak@1mm..2mm"})
    EXPECT_EQ(parse_recording_part(wrong).error().kind, ErrorKind::usage) << wrong;
}

}  // namespace
}  // namespace tacto::capture
