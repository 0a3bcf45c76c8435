// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/ridge_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware-host/sim/physics/random.hpp"

namespace tacto::firmware_host {
namespace {

constexpr double kPitchM = 2e-6;

HeightProfile ramp(double slope) {
  std::vector<double> heights;
  for (int i = 0; i <= 10000; ++i) heights.push_back(slope * i * kPitchM);
  return {kPitchM, heights};
}

HeightProfile wavy(double amplitude_m) {
  std::vector<double> heights;
  for (int i = 0; i <= 10000; ++i)
    heights.push_back(amplitude_m * std::sin(2 * std::numbers::pi * i * kPitchM / 1.3e-3));
  return {kPitchM, heights};
}

// The same contact by bisection on the base's height, with evenly spaced ridges.
double by_bisection(const FingerParameters& finger, const HeightProfile& profile, double x_m, double load_n) {
  const auto count = static_cast<int>(finger.patch_m / finger.ridge_spacing_m);
  const auto at = [&](int i) { return profile.at(x_m + finger.ridge_spacing_m * (i - (count - 1) / 2.0)); };
  const auto carried = [&](double base_m) {
    double sum = 0;
    for (int i = 0; i < count; ++i)
      sum += finger.ridge_stiffness_n_per_m * std::max(0.0, at(i).height_m - base_m);
    return sum;
  };
  double low = -1, high = 1;
  for (int step = 0; step < 200; ++step) (carried((low + high) / 2) > load_n ? low : high) = (low + high) / 2;
  double force = 0;
  for (int i = 0; i < count; ++i)
    force += finger.ridge_stiffness_n_per_m * std::max(0.0, at(i).height_m - low) * at(i).slope;
  return force;
}

TEST(RidgeContact, AFlatSurfaceGivesFrictionOnly) {
  RidgeContact contact({}, HeightProfile(kPitchM, std::vector<double>(10001)), 1);
  EXPECT_EQ(contact.slope_force_n(10e-3, 0.5), 0);
  EXPECT_EQ(contact.ridges(), 12U);
}

TEST(RidgeContact, ASlopeGivesItsShareOfTheLoadWhicheverRidgesCarryIt) {
  for (const double slope : {0.001, 0.01, 0.1}) {
    RidgeContact contact({}, ramp(slope), 1);
    EXPECT_NEAR(contact.slope_force_n(10e-3, 0.5), 0.5 * slope, 1e-6 * slope) << slope;
  }
}

TEST(RidgeContact, NewtonAndBisectionAgreeWithAndWithoutLiftOff) {
  FingerParameters finger;
  finger.ridge_jitter = 0;
  for (const double amplitude_m : {1e-6, 20e-6, 80e-6}) {
    const HeightProfile profile = wavy(amplitude_m);
    RidgeContact contact(finger, profile, 1);
    const HeightProfile smoothed = softened(profile, finger.ridge_width_m);
    for (double x_m = 5e-3; x_m < 15e-3; x_m += 0.173e-3)
      EXPECT_NEAR(contact.slope_force_n(x_m, 0.5), by_bisection(finger, smoothed, x_m, 0.5), 1e-9) << x_m;
  }
}

TEST(RidgeContact, WithoutLoadThereIsNoForce) {
  RidgeContact contact({}, wavy(50e-6), 1);
  EXPECT_EQ(contact.slope_force_n(10e-3, 0), 0);
  EXPECT_EQ(contact.slope_force_n(10e-3, -1), 0);
  EXPECT_EQ(contact.slope_force_n(10e-3, std::nan("")), 0);
}

}  // namespace
}  // namespace tacto::firmware_host
