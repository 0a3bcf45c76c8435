// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "data-schema/files/files.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/data-schema/texts.hpp"

namespace tacto::schema {
namespace {

class TransducerFile : public testing::Test {
 protected:
  std::string written(const Transducer& transducer, const std::string& stem) {
    EXPECT_TRUE(write_transducer(folder_ / stem, transducer));
    return read_file(folder_ / (stem + ".transducer.json")).value();
  }
  void write(const std::string& name, const std::string& text) {
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder_ / name, text));
    ASSERT_TRUE(pending.commit());
  }
  tests::TemporaryFolder folder_;
  Transducer preset_ = read_transducer("wiertlewski2011").value();
};

TEST_F(TransducerFile, ListsThePresets) {
  EXPECT_EQ(preset_names(), (std::vector<std::string_view>{"wiertlewski2011", "wiertlewski2011-as-printed"}));
}

TEST_F(TransducerFile, PresetKeepsThePapersTable) {
  EXPECT_EQ(preset_.deflection_m, 82.35e-6);
  EXPECT_EQ(preset_.bender_stiffness_n_per_m, 76.47e3);
  EXPECT_EQ(preset_.mass_kg, 6.8e-3);
  EXPECT_EQ(preset_.capacitance_f, 818e-9);
  EXPECT_EQ(preset_.drive_limit_v * preset_.amplifier_gain, preset_.max_voltage_v);
  EXPECT_NEAR(preset_.slew_limit_v_per_s, 2 * 3.14159265 * 500 * 5, 0.5);
  EXPECT_NE(preset_.origin.find("15708"), std::string::npos);
  const Transducer printed = read_transducer("wiertlewski2011-as-printed").value();
  EXPECT_EQ(printed.flexure_stiffness_n_per_m, 4.05e-3);
  EXPECT_EQ(printed.damping_n_s_per_m, 4490);
  EXPECT_EQ(printed.actuator_scale, 0.5);
}

TEST_F(TransducerFile, NumbersThatNoTransducerHasAreRefusedByName) {
  struct Odd {
    double Transducer::*member;
    const char* name;
    double value;
  };
  for (const auto& [member, name, value] :
       {Odd{&Transducer::actuator_scale, "actuator_scale", 1e12}, Odd{&Transducer::mass_kg, "mass_kg", 1e-12},
        Odd{&Transducer::flexure_stiffness_n_per_m, "flexure_stiffness_n_per_m", 2147483648.0},
        Odd{&Transducer::displacement_limit_m, "displacement_limit_m", 5}}) {
    Transducer odd = preset_;
    odd.*member = value;
    written(odd, "odd");
    const auto refused = read_transducer(folder_ / "odd");
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
    EXPECT_TRUE(refused.error().where.ends_with(std::string("odd.transducer.json#/") + name))
        << refused.error().where;
    EXPECT_TRUE(read_transducer(folder_ / "odd", Numbers::computable)) << name << ": insisted on";
  }
}

TEST_F(TransducerFile, WhatNobodyCanComputeWithIsRefusedToThoseWhoInsist) {
  for (const double value : {1e-300, 1e300}) {
    Transducer odd = preset_;
    odd.actuator_scale = value;
    written(odd, "odd");
    const auto refused = read_transducer(folder_ / "odd", Numbers::computable);
    ASSERT_FALSE(refused) << value;
    EXPECT_TRUE(refused.error().where.ends_with("#/actuator_scale")) << refused.error().where;
  }
  Transducer odd = preset_;
  odd.actuator_scale = odd.deflection_m = 1e-12;
  written(odd, "odd");
  EXPECT_EQ(read_transducer(folder_ / "odd", Numbers::computable).error().where,
            folder_ / "odd.transducer.json");
}

TEST_F(TransducerFile, ASecondModeAndAHysteresisHaveRangesToo) {
  Transducer odd = preset_;
  odd.second_mode = ModeAbove{1e12, 0.02, 1900, 0.02};
  written(odd, "odd");
  EXPECT_TRUE(read_transducer(folder_ / "odd").error().where.ends_with("#/second_mode/frequency_hz"));
  odd = preset_;
  odd.hysteresis = Hysteresis{{0, 1e9}, {1, 1}};
  written(odd, "odd");
  EXPECT_TRUE(read_transducer(folder_ / "odd").error().where.ends_with("#/hysteresis/thresholds_v/1"));
}

TEST_F(TransducerFile, ReadsBackToTheBit) {
  written(preset_, "bench");
  for (const char* name : {"bench", "bench.transducer.json", "bench.transducer"}) {
    const auto read = read_transducer(folder_ / name);
    ASSERT_TRUE(read) << message(read.error());
    EXPECT_EQ(read->name, preset_.name);
    EXPECT_EQ(read->sensor_scale, preset_.sensor_scale);
    EXPECT_EQ(read->converter_bits, 16);
    EXPECT_EQ(read->slew_limit_v_per_s, preset_.slew_limit_v_per_s);
    EXPECT_EQ(read->origin, preset_.origin);
    EXPECT_EQ(read->newer_version, "");
  }
}

TEST_F(TransducerFile, KeepsWhatWasIdentified) {
  Transducer found = preset_;
  found.hysteresis = Hysteresis{{0, 0.5, 2}, {0.75, 0.2, 0.1}};
  found.second_mode = ModeAbove{803.5, 0.03, 740.25, 0.02};
  found.reconstruction_cutoff_hz = 612.5;
  found.identification = Identification{
      "2026-11-22T05:00:00Z", "no load, 0.2 V", "sim:", "test", true, true, "misfit", 0.99, 10, 900};
  written(found, "found");
  const auto read = read_transducer(folder_ / "found");
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(read->hysteresis->thresholds_v, found.hysteresis->thresholds_v);
  EXPECT_EQ(read->hysteresis->weights, found.hysteresis->weights);
  EXPECT_EQ(read->second_mode->frequency_hz, 803.5);
  EXPECT_EQ(read->second_mode->zero_hz, 740.25);
  EXPECT_EQ(read->reconstruction_cutoff_hz, 612.5);
  EXPECT_TRUE(read->identification->misfit);
  EXPECT_FALSE(read->identification->usable());
  EXPECT_EQ(read->identification->conditions, "no load, 0.2 V");
  EXPECT_EQ(read->identification->high_hz, 900);
  EXPECT_EQ(read->extra_json, "");
}

TEST_F(TransducerFile, RefusesAHysteresisWithoutAnInverse) {
  const std::vector<Hysteresis> unfit = {
      {{0, 1}, {1}}, {{0.1, 1}, {0.5, 0.5}}, {{0, 2, 1}, {0.5, 0.3, 0.2}}, {{0, 1}, {0, 1}}};
  for (const Hysteresis& hysteresis : unfit) {
    Transducer transducer = preset_;
    transducer.hysteresis = hysteresis;
    const auto saved = write_transducer(folder_ / "unfit", transducer);
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().kind, ErrorKind::malformed);
    EXPECT_NE(saved.error().where.find("#/hysteresis"), std::string::npos);
  }
  Transducer band = preset_;
  band.identification = Identification{"2026-11-22T05:00:00Z", "", "sim:", "", true, false, "", 0.9, 500, 10};
  EXPECT_FALSE(write_transducer(folder_ / "band", band));
  EXPECT_EQ(folder_.files(), 0u);
}

TEST_F(TransducerFile, UnknownNameListsThePresets) {
  const auto read = read_transducer(folder_ / "nobody");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::not_found);
  EXPECT_NE(message(read.error()).find("wiertlewski2011-as-printed"), std::string::npos);
}

TEST_F(TransducerFile, LimitsAreObligatoryAndAboveZero) {
  const std::string sound = written(preset_, "sound");
  write("a.transducer.json", replaced(sound, "\"drive_limit_v\"", "\"drive_limit\""));
  const auto without = read_transducer(folder_ / "a");
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().kind, ErrorKind::malformed);
  EXPECT_NE(message(without.error()).find("drive_limit_v"), std::string::npos);
  for (const char* limit : {"drive_limit_v", "displacement_limit_m", "slew_limit_v_per_s"}) {
    const std::string key = std::string("\"") + limit + "\": ";
    write("b.transducer.json", replaced(sound, key, key + "0, \"was\": "));
    const auto zero = read_transducer(folder_ / "b");
    ASSERT_FALSE(zero) << limit;
    EXPECT_NE(zero.error().where.find("#/" + std::string(limit)), std::string::npos) << message(zero.error());
  }
}

TEST_F(TransducerFile, RefusesToWriteWhatItWouldNotRead) {
  Transducer limitless = preset_;
  limitless.slew_limit_v_per_s = 0;
  EXPECT_FALSE(write_transducer(folder_ / "limitless", limitless));
  EXPECT_EQ(folder_.files(), 0u);
}

TEST_F(TransducerFile, NewerMinorIsReadAndKeptNewerMajorRefused) {
  const std::string sound = written(preset_, "sound");
  const std::string newer =
      replaced(sound, "\"version\": \"1.0\"", "\"version\": \"1.7\", \"tray\": {\"colour\": \"red\"}");
  write("newer.transducer.json", newer);
  const auto read = read_transducer(folder_ / "newer");
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(read->newer_version, "1.7");
  EXPECT_NE(written(*read, "again").find("\"colour\": \"red\""), std::string::npos);

  write("future.transducer.json", replaced(sound, "\"1.0\"", "\"2.0\""));
  const auto future = read_transducer(folder_ / "future");
  ASSERT_FALSE(future);
  EXPECT_EQ(future.error().kind, ErrorKind::unsupported_version);
}

}  // namespace
}  // namespace tacto::schema
