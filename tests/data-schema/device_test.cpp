// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/device/device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

class DeviceFile : public testing::Test {
 protected:
  void write_text(const std::string& stem, const nlohmann::json& body) {
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder_ / (stem + ".device.json"), body.dump()));
    ASSERT_TRUE(pending.commit());
  }
  nlohmann::json body_of(const std::string& stem) {
    return nlohmann::json::parse(read_file(folder_ / (stem + ".device.json")).value());
  }
  nlohmann::json good_body() {
    EXPECT_TRUE(write_device(folder_ / "good", preset_));
    return body_of("good");
  }
  Error error_of(const std::function<void(nlohmann::json&)>& change) {
    nlohmann::json body = good_body();
    change(body);
    write_text("odd", body);
    const auto refused = read_device(folder_ / "odd");
    EXPECT_FALSE(refused) << body;
    return refused ? Error{} : refused.error();
  }
  void expect_error(const std::function<void(nlohmann::json&)>& change, ErrorKind kind, const std::string& at,
                    const std::string& words) {
    const Error error = error_of(change);
    EXPECT_EQ(error.kind, kind) << message(error);
    EXPECT_TRUE(error.where.ends_with("odd.device.json" + at)) << message(error);
    EXPECT_NE(message(error).find(words), std::string::npos) << message(error);
  }

  tests::TemporaryFolder folder_;
  Device preset_ = read_device("sandpaper-1990").value();
};

TEST_F(DeviceFile, ThePresetHasThePapersFrictionAndSaysWhatIsOurs) {
  EXPECT_EQ(device_preset_names(), (std::vector<std::string_view>{"arm", "sandpaper-1990"}));
  ASSERT_EQ(preset_.axes.size(), 2U);
  EXPECT_EQ(preset_.axes[0].name, "x");
  EXPECT_EQ(preset_.axes[1].name, "y");
  for (const DeviceAxis& axis : preset_.axes) EXPECT_EQ(axis.viscous_n_s_per_m, 1.17);  // Minsky 1990
  EXPECT_NE(preset_.source.find("Minsky"), std::string::npos);
  EXPECT_NE(preset_.notes.find("All other values are ours"), std::string::npos);
}

TEST_F(DeviceFile, ReadsBackToTheBit) {
  Device device = preset_;
  device.axes.resize(1);
  device.axes[0] = {"z", 0.1 / 3, 1.17, 0.01, 1e-6 / 3, -0.05, 0.07, 9.7, 2.3};
  device.delay_s = 1e-4 / 3;
  device.rates_hz = {100, 1000.0 / 3};
  device.transducer = "wiertlewski2011";
  device.notes = "a note";
  ASSERT_TRUE(write_device(folder_ / "one", device));
  for (const char* name : {"one", "one.device", "one.device.json"}) {
    const auto read = read_device(folder_ / name);
    ASSERT_TRUE(read) << message(read.error());
    ASSERT_EQ(read->axes.size(), 1U);
    const DeviceAxis &axis = read->axes[0], &kept = device.axes[0];
    EXPECT_EQ(std::tie(axis.name, axis.mass_kg, axis.viscous_n_s_per_m, axis.coulomb_n, axis.encoder_step_m),
              std::tie(kept.name, kept.mass_kg, kept.viscous_n_s_per_m, kept.coulomb_n, kept.encoder_step_m));
    EXPECT_EQ(std::tie(axis.travel_from_m, axis.travel_to_m, axis.peak_force_n, axis.continuous_force_n),
              std::tie(kept.travel_from_m, kept.travel_to_m, kept.peak_force_n, kept.continuous_force_n));
    EXPECT_EQ(std::tie(read->peak_force_n, read->continuous_force_n, read->slew_n_per_s, read->delay_s),
              std::tie(device.peak_force_n, device.continuous_force_n, device.slew_n_per_s, device.delay_s));
    EXPECT_EQ(std::tie(read->name, read->rates_hz, read->transducer, read->source, read->notes),
              std::tie(device.name, device.rates_hz, device.transducer, device.source, device.notes));
    EXPECT_EQ(read->newer_version, "");
  }
}

TEST_F(DeviceFile, NumbersThatNoDeviceHasAreRefusedWithValueAndRange) {
  struct Odd {
    const char* member;
    double value;
    const char* words;
  };
  for (const auto& [member, value, words] :
       {Odd{"mass_kg", 1e4, "mass_kg is 10000: a plausible value is from 0.001 to 100"},
        Odd{"viscous_n_s_per_m", 1e5, "a plausible value is from 0.0001 to 10000"},
        Odd{"coulomb_n", 1e-9, "coulomb_n is 1e-09"}, Odd{"encoder_step_m", 1, "encoder_step_m is 1"},
        Odd{"peak_force_n", 1e6, "peak_force_n is 1e+06"},
        Odd{"continuous_force_n", 1e-6, "continuous_force_n is 1e-06"}})
    expect_error([&](auto& body) { body["axes"][1][member] = value; }, ErrorKind::unsuitable,
                 std::string("#/axes/1/") + member, words);
  for (const auto& [member, value, words] :
       {Odd{"peak_force_n", 1e-6, "peak_force_n is 1e-06"}, Odd{"continuous_force_n", 1e5, "to 10000"},
        Odd{"slew_n_per_s", 1e12, "slew_n_per_s is 1e+12"}, Odd{"delay_s", 2, "delay_s is 2"}})
    expect_error([&](auto& body) { body[member] = value; }, ErrorKind::unsuitable, std::string("#/") + member,
                 words);
  expect_error([](auto& body) { body["rates_hz"][5] = 1e9; }, ErrorKind::unsuitable, "#/rates_hz/5",
               "rates_hz/5 is 1e+09");
  expect_error(
      [](auto& body) {
        body["axes"][0]["travel_m"] = {-0.1, 1000};
      },
      ErrorKind::unsuitable, "#/axes/0/travel_m/1", "is 1000: a plausible value is from -10 to 10");
}

TEST_F(DeviceFile, WhatContradictsItselfIsRefused) {
  using Body = nlohmann::json;
  expect_error([](Body& body) { body["axes"][1]["name"] = "x"; }, ErrorKind::unsuitable, "#/axes/1/name",
               "two axes are named 'x'");
  expect_error(
      [](Body& body) {
        body["axes"][0]["travel_m"] = {0.1, -0.1};
      },
      ErrorKind::unsuitable, "#/axes/0/travel_m", "has to increase");
  expect_error(
      [](Body& body) {
        body["axes"][0]["travel_m"] = {0, 1e-5};
      },
      ErrorKind::unsuitable, "#/axes/0/travel_m", "by more than an encoder step");
  expect_error([](Body& body) { body["axes"][0]["continuous_force_n"] = 21; }, ErrorKind::unsuitable,
               "#/axes/0/continuous_force_n", "above the peak_force_n of 20");
  expect_error([](Body& body) { body["continuous_force_n"] = 21; }, ErrorKind::unsuitable,
               "#/continuous_force_n", "above the peak_force_n of 20");
  expect_error(
      [](Body& body) {
        body["rates_hz"] = {1000, 1000};
      },
      ErrorKind::unsuitable, "#/rates_hz/1", "rates have to increase");
}

TEST_F(DeviceFile, FaultsOfFormAreNamedByJsonPointer) {
  using Body = nlohmann::json;
  expect_error([](Body& body) { body["axes"] = Body::array(); }, ErrorKind::malformed, "#/axes", "");
  expect_error(
      [](Body& body) {
        body["axes"] = {body["axes"][0], body["axes"][0], body["axes"][0], body["axes"][1]};
      },
      ErrorKind::malformed, "#/axes", "");
  expect_error([](Body& body) { body["axes"][0]["name"] = "w"; }, ErrorKind::malformed, "#/axes/0/name",
               "\"w\" is not one of x, y, z");
  expect_error([](Body& body) { body["axes"][0].erase("mass_kg"); }, ErrorKind::malformed, "#/axes/0",
               "mass_kg");
  expect_error([](Body& body) { body["axes"][0]["mass_kg"] = -1; }, ErrorKind::malformed, "#/axes/0/mass_kg",
               "Mass that the hand moves along this axis");
  expect_error([](Body& body) { body["axes"][0]["travel_m"] = Body::array({0}); }, ErrorKind::malformed,
               "#/axes/0/travel_m", "");
  expect_error([](Body& body) { body["rates_hz"] = Body::array(); }, ErrorKind::malformed, "#/rates_hz", "");
  expect_error([](Body& body) { body["delay_s"] = "none"; }, ErrorKind::malformed, "#/delay_s", "");
  expect_error([](Body& body) { body["version"] = "2.0"; }, ErrorKind::unsupported_version, "", "2.0");
  expect_error([](Body& body) { body["kind"] = "hand"; }, ErrorKind::malformed, "#/kind",
               "'hand', not 'device'");
}

TEST_F(DeviceFile, WhatIsMisspeltIsRefusedWithTheNearest) {
  expect_error([](auto& body) { body["axes"][1]["encoder_stp_m"] = 1; }, ErrorKind::malformed,
               "#/axes/1/encoder_stp_m", "did you mean 'encoder_step_m'?");
  expect_error([](auto& body) { body["slew_n_per_ms"] = 1; }, ErrorKind::malformed, "#/slew_n_per_ms",
               "did you mean 'slew_n_per_s'?");
  // A required member that is misspelt is missing, too.
  expect_error(
      [](auto& body) {
        body["delay_ms"] = body["delay_s"];
        body.erase("delay_s");
      },
      ErrorKind::malformed, "",
      "Missing required property 'delay_s'; 'delay_ms' is probably a misspelling of it");
}

TEST_F(DeviceFile, NotFoundNamesThePresets) {
  const auto missing = read_device(folder_ / "none");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::not_found);
  EXPECT_EQ(missing.error().remedy, "the presets are arm, sandpaper-1990; a file is NAME.device.json");
}

TEST_F(DeviceFile, NeitherNanNorAnImplausibleNumberIsWritten) {
  Device odd = preset_;
  odd.axes[1].mass_kg = std::numeric_limits<double>::quiet_NaN();
  const auto refused = write_device(folder_ / "nan", odd);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  EXPECT_TRUE(refused.error().where.ends_with("nan.device.json#/axes/1/mass_kg")) << refused.error().where;
  EXPECT_FALSE(is_file(folder_ / "nan.device.json"));
  odd.axes[1].mass_kg = 0.1;
  odd.axes.clear();
  EXPECT_FALSE(write_device(folder_ / "nan", odd));
}

TEST_F(DeviceFile, ANewerMinorVersionIsReadAndItsMembersAreKept) {
  nlohmann::json body = good_body();
  body["version"] = "1.8";
  body["brake"] = true;
  body["axes"][1]["inertia"] = {{"a", 1}};
  write_text("newer", body);
  const auto newer = read_device(folder_ / "newer");
  ASSERT_TRUE(newer) << message(newer.error());
  EXPECT_EQ(newer->newer_version, "1.8");
  ASSERT_TRUE(write_device(folder_ / "again", *newer));
  EXPECT_EQ(body_of("again"), body);
}

TEST_F(DeviceFile, TheCheckFindsPresetsFilesAndTheTraysTransducer) {
  EXPECT_EQ(stored_files("sandpaper-1990").value().front().kind, FileKind::device);
  EXPECT_TRUE(check_file({FileKind::device, "sandpaper-1990"})->findings.empty());
  Device device = preset_;
  device.transducer = "bench";
  ASSERT_TRUE(write_device(folder_ / "both", device));
  const std::string path = folder_ / "both.device.json";
  EXPECT_EQ(stored_files(folder_ / "both").value().front().kind, FileKind::device);
  EXPECT_EQ(stored_files(path).value().front().kind, FileKind::device);
  ASSERT_EQ(check_file({FileKind::device, path})->findings.size(), 1U);
  EXPECT_EQ(check_file({FileKind::device, path})->findings[0].where, path + "#/transducer");
  ASSERT_TRUE(write_transducer(folder_ / "bench", read_transducer("wiertlewski2011").value()));
  EXPECT_TRUE(check_file({FileKind::device, path})->findings.empty());
  nlohmann::json body = body_of("both");
  body["delay_s"] = 2;
  write_text("both", body);
  EXPECT_EQ(check_file({FileKind::device, path})->findings.at(0).where, path + "#/delay_s");
}

}  // namespace
}  // namespace tacto::schema
