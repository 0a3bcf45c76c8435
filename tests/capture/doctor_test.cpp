// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/doctor/doctor.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "capture/calibrate/tare.hpp"
#include "tests/capture/sim_take.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using tests::TemporaryFolder;
namespace fs = std::filesystem;

const Check& check_named(const Diagnosis& diagnosis, const std::string& name) {
  for (const Check& check : diagnosis.checks)
    if (check.name == name) return check;
  throw std::runtime_error(name);
}

DoctorRequest doctor_request(const TemporaryFolder& folder, const std::string& device) {
  setenv("XDG_CONFIG_HOME", (folder / "config").c_str(), 1);
  DoctorRequest made;
  made.device = device;
  made.folder = folder / "";
  made.questions = 20;
  return made;
}

TEST(Doctor, AnEmulatedDeviceCanRecord) {
  const TemporaryFolder folder;
  const Diagnosis diagnosis = examine(doctor_request(folder, "sim:surface=C"));
  EXPECT_EQ(diagnosis.first_failure(), nullptr);
  ASSERT_EQ(diagnosis.checks.size(), 8U);
  const char* kOrder[] = {"device",    "permission", "firmware",        "round trip",
                          "real time", "disk",       "temporary files", "calibration"};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(diagnosis.checks[i].name, kOrder[i]);
  EXPECT_NE(check_named(diagnosis, "device").found.find("emulated"), std::string::npos);
  EXPECT_NE(check_named(diagnosis, "round trip").found.find("99 of 100"), std::string::npos);
  EXPECT_EQ(check_named(diagnosis, "calibration").health, Health::warns);
  EXPECT_EQ(diagnosis.next, "tactograph calibrate tare -d sim:surface=C,finger=up,strokes=0");
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Doctor, WarnsOfAFirmwareOlderThanTheProtocol) {
  firmware_host::Capabilities said;
  said.firmware = "0.1.0 build 0123abcd";
  for (const unsigned same_or_newer : {2U, 3U}) {
    const Check check = check_firmware(said, same_or_newer, 2);
    EXPECT_EQ(check.health, Health::works);
    EXPECT_TRUE(check.remedy.empty());
  }
  const Check older = check_firmware(said, 1, 2);
  EXPECT_EQ(older.health, Health::warns);
  EXPECT_NE(older.found.find("0123abcd"), std::string::npos);
  EXPECT_NE(older.found.find("1.1, here 1.2"), std::string::npos) << older.found;
  EXPECT_NE(older.remedy.find("firmware-host/boards/README.md"), std::string::npos);
}

// The command that the refusal suggests works: a moving finger is not still.
TEST(Doctor, TheTareItAsksForOfAnEmulatedDeviceCanBeMade) {
  const TemporaryFolder folder;
  const DoctorRequest asked = doctor_request(folder, "sim:finger=down,seed=3,strokes=9");
  firmware_host::Capabilities said;
  said.serial = "none-of-this";
  EXPECT_EQ(check_calibration(said, asked).remedy,
            "tactograph calibrate tare -d sim:seed=3,finger=up,strokes=0");
  const Take take = sim_take("seed=3,finger=up,strokes=0", 1);
  EXPECT_TRUE(tare_of(take)->motion_signs.empty());
}

TEST(Doctor, WithoutADeviceItSaysSoAndLooksAtTheRest) {
  const TemporaryFolder folder;
  const Diagnosis diagnosis = examine(doctor_request(folder, "usb:serial=no-such-device"));
  ASSERT_NE(diagnosis.first_failure(), nullptr);
  EXPECT_EQ(diagnosis.first_failure()->name, "device");
  EXPECT_EQ(check_named(diagnosis, "round trip").health, Health::skipped);
  EXPECT_NE(check_named(diagnosis, "disk").health, Health::fails);
  EXPECT_NE(diagnosis.next.find("sim:surface=C"), std::string::npos);
}

TEST(Doctor, AReplayAnswersNoQuestions) {
  struct Silent final : firmware_host::Device {
    const firmware_host::Capabilities& capabilities() const override { return can; }
    schema::Result<void> start() override { return {}; }
    schema::Result<std::size_t> read(std::span<std::int32_t>) override { return 0; }
    schema::Result<void> stop() override { return {}; }
    firmware_host::StreamCounts counts() const override { return {}; }
    firmware_host::Capabilities can;
  } replay;
  EXPECT_EQ(check_round_trip(replay, 5).health, Health::skipped);
}

TEST(Doctor, ADeviceThatDoesNotAnswerFails) {
  struct Broken final : firmware_host::Device {
    const firmware_host::Capabilities& capabilities() const override { return can; }
    schema::Result<void> start() override { return {}; }
    schema::Result<std::size_t> read(std::span<std::int32_t>) override { return 0; }
    schema::Result<void> stop() override { return {}; }
    firmware_host::StreamCounts counts() const override { return {}; }
    schema::Result<double> round_trip_s() override {
      return schema::fail(ErrorKind::device, "the device did not answer heartbeat");
    }
    firmware_host::Capabilities can;
  } broken;
  EXPECT_EQ(check_round_trip(broken, 5).health, Health::fails);
}

TEST(Doctor, AFolderThatIsNotThereFails) {
  const TemporaryFolder folder;
  DoctorRequest asked = doctor_request(folder, "sim:");
  asked.folder = folder / "none";
  const Diagnosis diagnosis = examine(asked);
  ASSERT_NE(diagnosis.first_failure(), nullptr);
  EXPECT_EQ(diagnosis.first_failure()->name, "disk");
  EXPECT_EQ(diagnosis.first_failure()->fault, ErrorKind::cannot_write);
}

TEST(Doctor, AReadOnlyFolderFails) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  const std::string place = geteuid() == 0 ? "/proc" : folder / "locked";  // root can write anywhere else
  const Check check = check_disk(place, 160e3);
  EXPECT_EQ(check.health, Health::fails);
  EXPECT_EQ(check.fault, ErrorKind::cannot_write);
}

TEST(Doctor, ADiskTooSlowForTheStreamFails) {
  const TemporaryFolder folder;
  EXPECT_EQ(check_disk(folder / "", 160e3).health == Health::fails, false);
  const Check check = check_disk(folder / "", 1e12);
  EXPECT_EQ(check.health, Health::fails);
}

TEST(DiskSpeed, LeavesNothingBehind) {
  const TemporaryFolder folder;
  const auto disk = measure_disk(folder / "", 8000);
  ASSERT_TRUE(disk) << schema::message(disk.error());
  EXPECT_GT(disk->write_bytes_per_s, 0);
  EXPECT_GE(disk->sync_worst_s, disk->sync_median_s);
  EXPECT_GT(disk->free_bytes, 0);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Doctor, TheRuleForPermissionIsLookedForWhereUdevDoes) {
  const TemporaryFolder folder;
  const schema::Error denied{ErrorKind::not_found, "this user may not open the device", "usb:", ""};
  const Check without = check_permission(denied, folder / "");
  EXPECT_EQ(without.health, Health::fails);
  EXPECT_NE(without.remedy.find("/etc/udev/rules.d/60-tactograph.rules"), std::string::npos);
  EXPECT_NE(without.remedy.find(std::string(kUdevRule)), std::string::npos);
  fs::create_directories(folder / "etc/udev/rules.d");
  std::ofstream(folder / "etc/udev/rules.d/60-tactograph.rules") << "\n";
  const Check with = check_permission(denied, folder / "");
  EXPECT_EQ(with.health, Health::fails);
  EXPECT_NE(with.remedy.find("plugdev"), std::string::npos);
  EXPECT_TRUE(is_denied(denied));
  const schema::Error absent{ErrorKind::not_found, "there is no device of ours on USB", "usb:", ""};
  EXPECT_EQ(check_permission(absent, folder / "").health, Health::works);
}

TEST(Doctor, TheRuleItGivesIsTheOneThatIsInstalled) {
  std::ifstream rules(TACTO_SOURCE "/firmware-host/usb/60-tactograph.rules");
  std::string line, last;
  while (std::getline(rules, line))
    if (!line.starts_with('#')) last = line;
  EXPECT_EQ(last, kUdevRule);
}

TEST(RealtimeLimits, ReadTheKernelsThrottle) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "proc/sys/kernel");
  const auto set = [&](const char* runtime) {
    std::ofstream(folder / "proc/sys/kernel/sched_rt_runtime_us") << runtime;
    std::ofstream(folder / "proc/sys/kernel/sched_rt_period_us") << "1000000";
  };
  EXPECT_FALSE(realtime_limits(folder / "").runtime);
  set("950000");
  EXPECT_NEAR(*realtime_limits(folder / "").runtime, 0.95, 1e-12);
  set("-1");
  EXPECT_EQ(*realtime_limits(folder / "").runtime, 1);
  set("100000");
  const Check check = check_real_time(folder / "");
  EXPECT_EQ(check.health, Health::warns);  // for the throttle, or because no priority is granted
  EXPECT_NE(check.found.find("10 %"), std::string::npos);
}

TEST(Doctor, AStaleCalibrationAndAnothersAreTold) {
  const TemporaryFolder folder;
  const DoctorRequest asked = doctor_request(folder, "sim:");
  firmware_host::Capabilities said;
  said.serial = "T-1";
  said.channels.resize(1);
  said.channels[0].name = "normal_force";
  schema::CalibrationFile file{
      "T-1", {},
      {},    {{"normal_force", "N", "tare", "2020-01-01T00:00:00Z", 1, {}, {}, 5.0, 1.0, 19, {}, {}, {}}},
      {},    {}};
  ASSERT_TRUE(schema::write_calibration(*schema::calibration_path("T-1"), file));
  EXPECT_NE(check_calibration(said, asked).found.find("stale: normal_force"), std::string::npos);
  DoctorRequest patient = asked;
  patient.stale_after_s = 1e12;
  EXPECT_EQ(check_calibration(said, patient).health, Health::works);
  said.serial = "T-2";
  patient.calibration = *schema::calibration_path("T-1");
  EXPECT_EQ(check_calibration(said, patient).health, Health::fails);
}

}  // namespace
}  // namespace tacto::capture
