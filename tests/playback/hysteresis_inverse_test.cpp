// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/hysteresis_inverse.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware-host/core/kernel/play_operators.hpp"
#include "firmware-host/sim/physics/bender_hysteresis.hpp"
#include "firmware-host/sim/physics/random.hpp"
#include "tests/playback/made_textures.hpp"
#include "tests/playback/rayleigh_law.hpp"

namespace tacto::playback {
namespace {

// A random walk with reversals of all sizes, within +-4 V.
std::vector<double> walk(std::size_t count) {
  firmware_host::Random random(7, 1);
  std::vector<double> values;
  double x = 0;
  for (std::size_t i = 0; i < count; ++i) {
    x += 0.15 * random.normal();
    if (std::abs(x) > 4) x *= 0.9;
    values.push_back(x);
  }
  return values;
}

// Single precision: 1e-6 of 4 V, a few rounding errors of 6e-8.
TEST(HysteresisInverse, UndoesTheOperatorFromRest) {
  const schema::Hysteresis law = rayleigh(0.16, 5, wire::kMaxPlays);
  core::PlayOperators inverse;
  inverse.set(inverse_of(law));
  std::vector<double> play_operators(law.weights.size());
  double largest = 0, moved = 0;
  for (const double target : walk(20000)) {
    const double v = inverse.follow(static_cast<float>(target));
    double u = 0;
    for (std::size_t i = 0; i < play_operators.size(); ++i) {
      play_operators[i] =
          std::max(v - law.thresholds_v[i], std::min(v + law.thresholds_v[i], play_operators[i]));
      u += law.weights[i] * play_operators[i];
    }
    largest = std::max(largest, std::abs(u - target));
    moved = std::max(moved, std::abs(v - target));
  }
  EXPECT_LT(largest, 4e-6);
  EXPECT_GT(moved, 0.5) << "an inverse that does nothing proves nothing";
}

// The emulated bender has 32 play operators, twice as many as the kernel holds. Error of the merging, re the
// hysteresis.
TEST(HysteresisInverse, MergesPlaysThatAreTooMany) {
  const wire::Hysteresis few = inverse_of(rayleigh(0.16, 5, 32));
  EXPECT_EQ(few.count, wire::kMaxPlays);
  core::PlayOperators inverse;
  inverse.set(few);
  firmware_host::BenderHysteresis bender(0.16, 5);
  double error = 0, hysteresis = 0;
  for (const double target : walk(20000)) {
    const double v = inverse.follow(static_cast<float>(target));
    bender.settle(v);
    error += std::pow(bender.at(v) - target, 2);
    hysteresis += std::pow(v - target, 2);
  }
  EXPECT_LT(std::sqrt(error / hysteresis), 0.03);
}

TEST(HysteresisInverse, OfNoHysteresisIsNothing) {
  const wire::Hysteresis none = inverse_of({{0}, {1}});
  EXPECT_EQ(none.count, 0);
  EXPECT_EQ(none.straight, 1.0F);
}

// A held drive charges the bender by 1 - a in a tick; the section inverts that.
TEST(HysteresisInverse, TheLeadUndoesTheAmplifiersLowPass) {
  const wire::Section lead = pole_lead(143, 2000);
  const double a = std::exp(-kTwoPi * 143 / 2000);
  double charge = 0, before = 0;
  for (const double target : walk(200)) {
    const double drive = lead.b0 * target + lead.b1 * before;
    before = target;
    charge = a * charge + (1 - a) * drive;
    EXPECT_NEAR(charge, target, 1e-5);
  }
}

TEST(HysteresisInverse, WhatADriveDoesIsWhatItUndoes) {
  const schema::Hysteresis law = rayleigh(0.16, 5, 12);
  core::PlayOperators inverse;
  inverse.set(inverse_of(law));
  const wire::Section lead = pole_lead(143, 2000);
  const std::vector<double> target = walk(5000);
  std::vector<double> drive;
  double before = 0;
  for (const double charge : target) {
    const double v = inverse.follow(static_cast<float>(charge));
    drive.push_back(lead.b0 * v + lead.b1 * before);
    before = v;
  }
  const std::vector<double> linear = linear_drive_of(drive, law, 143, 2000);
  const double a = std::exp(-kTwoPi * 143 / 2000);
  double charge = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    charge = a * charge + (1 - a) * linear[i];
    ASSERT_NEAR(charge, target[i], 3e-5);
  }
}

}  // namespace
}  // namespace tacto::playback
