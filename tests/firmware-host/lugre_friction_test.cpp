// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/lugre_friction.hpp"

#include <gtest/gtest.h>

#include "firmware-host/sim/physics/runge_kutta.hpp"

namespace tacto::firmware_host {
namespace {

// The friction after sliding at constant speed for a time, starting with relaxed bristles.
double after_sliding(double speed_mps, double time_s) {
  const FingerParameters finger;
  OdeState<1> bristle{};
  constexpr double kStepS = 1e-5;
  for (double t = 0; t < time_s; t += kStepS)
    bristle = runge_kutta_step(bristle, kStepS, [&](const OdeState<1>& z, double) {
      return OdeState<1>{lugre_friction(finger, z[0], speed_mps).bristle_rate_mps};
    });
  return lugre_friction(finger, bristle[0], speed_mps).coefficient;
}

TEST(LugreFriction, SlidesAtTheKineticCoefficientAgainstTheMotion) {
  EXPECT_NEAR(after_sliding(0.5, 0.1), 0.92,
              1e-4);  // 1.1e-5 of the static excess is left at 250 times its speed
  EXPECT_NEAR(after_sliding(-0.5, 0.1), -0.92, 1e-4);
}

TEST(LugreFriction, CreepsAtTheStaticCoefficient) {
  // 1e-4 of the excess has faded at a hundredth of the Stribeck speed.
  EXPECT_NEAR(after_sliding(2e-5, 10), 0.92 * 1.7, 1e-4);
}

TEST(LugreFriction, FadesToHalfTheExcessAtTheStribeckSpeed) {
  EXPECT_NEAR(after_sliding(2e-3, 1), 0.92 * (1 + 0.7 / 2), 1e-6);
}

TEST(LugreFriction, SpringsBeforeItSlides) {
  const double moved_m = 1e-6;
  const double speed_mps = 1e-5, time_s = moved_m / speed_mps;
  const FingerParameters finger;
  const double spring = finger.bristle_stiffness_per_m * moved_m;
  EXPECT_NEAR(after_sliding(speed_mps, time_s), spring, 0.05 * spring);  // 3 % of it has begun to slide
}

}  // namespace
}  // namespace tacto::firmware_host
