// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/calibration/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

using tests::TemporaryFolder;

CalibrationFile made() {
  CalibrationEntry tare{"net_force", "N",  "tare",    "2026-11-01T00:00:00Z", 1e-9, {}, {}, 1234.5, 6.5, 19,
                        3e-3,        1e-4, {"a", "b"}};
  CalibrationEntry weights = tare;
  weights.method = "weights";
  weights.date = "2026-11-02T00:00:00Z";
  weights.scale = 0.1 + 0.2;  // digits to the last
  weights.scale_uncertainty = 1e-12;
  weights.noise_rms.reset();
  return {"T-1", "bench", "by a test", {tare, weights}, {}, {}};
}

TEST(Calibration, IsReadBackToTheBit) {
  const TemporaryFolder folder;
  const std::string path = folder / "new/T-1.calibration.json";
  ASSERT_TRUE(write_calibration(path, made()));
  const auto file = read_calibration(path);
  ASSERT_TRUE(file) << message(file.error());
  EXPECT_EQ(file->serial, "T-1");
  EXPECT_EQ(file->simulated, "by a test");
  ASSERT_EQ(file->entries.size(), 2U);
  EXPECT_EQ(file->entries[1].scale, 0.1 + 0.2);
  EXPECT_EQ(file->entries[0].zero, 1234.5);
  EXPECT_FALSE(file->entries[0].scale);
  EXPECT_EQ(file->entries[0].noise_density, 1e-4);
  EXPECT_FALSE(file->entries[1].noise_rms);
  EXPECT_EQ(file->entries[0].notes, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(check_file({FileKind::calibration, path})->findings.empty());
  EXPECT_EQ(stored_files(folder / "new/T-1")->front().kind, FileKind::calibration);
}

TEST(Calibration, WhatIsWrongInItIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder / "T-1.calibration.json";
  EXPECT_EQ(read_calibration(path).error().kind, ErrorKind::not_found);
  CalibrationFile file = made();
  file.entries[0].zero = NAN;
  EXPECT_EQ(write_calibration(path, file).error().where, "/entries/0/zero");
  file = made();
  file.entries[1].date = "yesterday";
  EXPECT_EQ(write_calibration(path, file).error().where, "/entries/1/date");
  EXPECT_EQ(folder.files(), 0U);
  std::ofstream(path) << R"({"kind": "calibration", "version": "1.0", "serial": "T-1"})";
  EXPECT_EQ(read_calibration(path).error().kind, ErrorKind::malformed);
  std::ofstream(path) << R"({"kind": "calibration", "version": "2.0", "serial": "T-1", "entries": []})";
  EXPECT_EQ(read_calibration(path).error().kind, ErrorKind::unsupported_version);
}

TEST(Calibration, WhatANewerVersionAddsIsKept) {
  const TemporaryFolder folder;
  const std::string path = folder / "T-1.calibration.json";
  std::ofstream(path)
      << R"({"kind": "calibration", "version": "1.9", "serial": "T-1", "entries": [], "room": "12"})";
  const auto file = read_calibration(path);
  ASSERT_TRUE(file);
  EXPECT_EQ(file->newer_version, "1.9");
  ASSERT_TRUE(write_calibration(path, *file));
  EXPECT_NE(read_file(path)->find("\"room\": \"12\""), std::string::npos);
}

TEST(Calibration, LiesWhereTheUsersFoldersAre) {
  setenv("XDG_CONFIG_HOME", "/x", 1);
  EXPECT_EQ(*calibration_path("T-1"), "/x/tactograph/calibrations/T-1.calibration.json");
  EXPECT_EQ(*calibration_path("../é 1"),
            "/x/tactograph/calibrations/_____"
            "_1.calibration.json");
  unsetenv("XDG_CONFIG_HOME");
  setenv("HOME", "/home/x", 1);
  EXPECT_EQ(*calibration_path("T-1"), "/home/x/.config/tactograph/calibrations/T-1.calibration.json");
  unsetenv("HOME");
  EXPECT_EQ(calibration_path("T-1").error().kind, ErrorKind::not_found);
  EXPECT_EQ(calibration_path("").error().kind, ErrorKind::unsuitable);
}

TEST(Calibration, TheNewestOfAChannelIsFound) {
  CalibrationFile file = made();
  EXPECT_EQ(newest_scale(file, "net_force"), &file.entries[1]);
  EXPECT_EQ(newest_zero(file, "net_force"), &file.entries[1]);
  file.entries[0].date = "2027-01-01T00:00:00Z";
  EXPECT_EQ(newest_zero(file, "net_force"), &file.entries[0]);
  EXPECT_EQ(newest_scale(file, "net_force"), &file.entries[1]);
  EXPECT_EQ(newest_scale(file, "position"), nullptr);
}

TEST(Calibration, AgesAreInSeconds) {
  EXPECT_EQ(seconds_between("2026-11-01T00:00:00Z", "2026-11-02T00:00:01Z"), 86401);
  EXPECT_EQ(seconds_between("2024-02-28", "2024-03-01"), 2 * 86400);
  EXPECT_FALSE(seconds_between("yesterday", "2024-03-01"));
  EXPECT_FALSE(seconds_between("2024-03-01T00:00:00Z and more", "2024-03-01"));
}

}  // namespace
}  // namespace tacto::schema
