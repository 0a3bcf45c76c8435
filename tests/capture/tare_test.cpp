// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/tare.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/capture/sim_take.hpp"

namespace tacto::capture {
namespace {

const ChannelTare& of(const Tare& tare, const Take& take, const std::string& name) {
  for (const ChannelTare& one : tare.channels)
    if (take.header.channels[one.channel].name == name) return one;
  throw std::runtime_error(name);
}

TEST(Tare, FindsTheLoadCellsZeroWithinItsUncertainty) {
  Coverage coverage;
  for (int seed = 1; seed <= 40; ++seed) {
    const Take take = sim_take(fmt::format("finger=up,cell_zero=0.05N,seed={}", seed), 1);
    const auto tare = tare_of(take);
    ASSERT_TRUE(tare);
    EXPECT_TRUE(tare->motion_signs.empty()) << tare->motion_signs.front();
    for (const char* name : {"normal_force", "net_force"}) {
      const ChannelTare& one = of(*tare, take, name);
      coverage.add(one.zero, 0.05 / take.header.channels[one.channel].scale);
    }
  }
  EXPECT_GE(coverage.inside(), 0.88);  // of 80: three sigma below 95 %
  EXPECT_LT(coverage.rms(), 1.4);
  EXPECT_GT(coverage.rms(), 0.7);
  coverage.print("tare.zero");
}

// 25 uN/sqrt(Hz) in the middle of the band; slightly less in newtons at 100 Hz.
TEST(Tare, FindsTheNoiseFloor) {
  const Take take = sim_take("finger=up", 5);
  const auto tare = tare_of(take);
  ASSERT_TRUE(tare);
  const ChannelTare& piezo = of(*tare, take, "tangential_force");
  EXPECT_NEAR(piezo.noise_density, 25e-6, 4e-6);
  EXPECT_NEAR(piezo.noise_rms, 25e-6 * std::sqrt(5000), 0.1 * 25e-6 * std::sqrt(5000));
  EXPECT_NEAR(of(*tare, take, "net_force").noise_rms, 1.0 / 320, 0.05 / 320);
}

TEST(Tare, NamesTheMainsAndOnlyWhereThereIsOne) {
  const Take humming = sim_take("finger=up,mains=20mV", 5);
  const auto tare = tare_of(humming);
  ASSERT_TRUE(tare);
  const auto& mains = of(*tare, humming, "tangential_force").mains;
  ASSERT_EQ(mains.size(), 2U);
  EXPECT_EQ(mains[0].frequency_hz, 50);
  EXPECT_EQ(mains[1].frequency_hz, 150);
  const double newtons_per_volt = std::abs(schema::nominal_newtons_per_volt(*humming.header.transducer));
  EXPECT_NEAR(mains[0].amplitude, 0.02 * newtons_per_volt, 0.1 * 0.02 * newtons_per_volt);
  EXPECT_TRUE(of(*tare, humming, "net_force").mains.empty());
  for (int seed = 1; seed <= 20; ++seed) {
    const Take quiet = sim_take(fmt::format("finger=up,seed={}", seed), 1);
    const auto tared = tare_of(quiet);
    ASSERT_TRUE(tared);
    for (const ChannelTare& one : tared->channels) EXPECT_TRUE(one.mains.empty()) << seed;
  }
}

TEST(Tare, LoudMainsIsNoFinger) {
  const auto tare = tare_of(sim_take("finger=up,mains=1V", 2));
  ASSERT_TRUE(tare);
  EXPECT_TRUE(tare->motion_signs.empty()) << tare->motion_signs.front();
}

TEST(Tare, AFingerThatSlidesIsNoticed) {
  const auto tare = tare_of(sim_take("surface=flat,strokes=4", 2));
  ASSERT_TRUE(tare);
  EXPECT_GE(tare->motion_signs.size(), 2U);  // the load wanders, and the piezo is loud
  EXPECT_NE(tare->warnings.back().find("position moved"), std::string::npos);
}

TEST(Tare, ALoadAtRestIsWarnedOf) {
  const auto tare = tare_of(sim_take("finger=up,weight=0.5N", 1));
  ASSERT_TRUE(tare);
  EXPECT_TRUE(tare->motion_signs.empty());
  ASSERT_EQ(tare->warnings.size(), 2U);
  EXPECT_NE(tare->warnings[0].find("0.5 N"), std::string::npos) << tare->warnings[0];
}

TEST(Tare, RefusesWhatIsTooShort) {
  EXPECT_EQ(tare_of(sim_take("finger=up", 0.5)).error().kind, schema::ErrorKind::unsuitable);
}

TEST(Tare, ItsEntriesSayItAll) {
  const Take take = sim_take("finger=up,mains=20mV", 2);
  const auto entries = entries_of(*tare_of(take), take);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].method, "tare");
  EXPECT_FALSE(entries[0].scale);
  EXPECT_EQ(entries[0].degrees_of_freedom, 19);
  EXPECT_NE(entries[0].notes.at(1).find("50 Hz"), std::string::npos);
}

}  // namespace
}  // namespace tacto::capture
