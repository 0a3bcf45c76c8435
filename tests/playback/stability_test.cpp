// SPDX-License-Identifier: GPL-3.0-or-later
// Limits of stability in closed form, by eigenvalues, and by motion in time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "firmware-host/sim/planar/axis_motion.hpp"
#include "playback/stability/free_limit.hpp"
#include "playback/stability/passive_limit.hpp"
#include "playback/stability/sampled_loop.hpp"
#include "playback/stability/sampled_spring.hpp"

namespace tacto::playback {
namespace {

// Issue 33; scipy.signal.cont2discrete and numpy.roots give the same (design_command_test.py).
TEST(FreeLimit, IsThatOfTheExactDiscretisation) {
  const double expected[][2] = {{0.01, 2.003}, {0.1, 2.034},  {1, 2.392},
                                {3, 3.560},    {3.72, 4.099}, {10, 2.500}};
  for (const auto& [u, c] : expected) {
    const double damping = u * 0.1 / 1e-3;
    EXPECT_NEAR(free_stiffness_limit(0.1, damping, 1e-3, 0) * 1e-3 / damping, c, 5e-4) << u;
  }
}

// Both ways are exact; the tolerance is that of issue 33, and the measured difference is below 1e-12.
TEST(FreeLimit, ClosedFormAndEigenvaluesAgree) {
  for (double u = 1e-9; u < 100; u *= 1.7) {
    const double damping = u * 0.1 / 1e-3, closed = free_stiffness_limit(0.1, damping, 1e-3, 0);
    EXPECT_NEAR(stiffness_limit({0.1, damping, 0}, {1e-3, 0}, 0) / closed, 1, 1e-6) << u;
  }
}

TEST(FreeLimit, WithDelayIsThatOfHulinForSmallDamping) {
  for (const double delay : {0.0, 0.5, 1.0, 2.0, 5.0, 50.0}) {
    const double limit = free_stiffness_limit(0.1, 1e-4, 1e-3, delay);
    EXPECT_NEAR(limit * 1e-3 / 1e-4 * (0.5 + delay), 1, 1e-4) << delay;
  }
}

TEST(FreeLimit, IsZeroWithoutDamping) {
  EXPECT_EQ(free_stiffness_limit(0.1, 0, 1e-3, 0), 0);
  EXPECT_EQ(free_stiffness_limit(0.1, 0, 1e-3, 2), 0);
}

/// Whether the mass, let go at 1 m, returns: the motion between the changes of the force is exact.
bool returns(double mass_kg, double damping, double period_s, double delay_ticks, double stiffness) {
  const int whole = static_cast<int>(delay_ticks);
  const double late_s = (delay_ticks - whole) * period_s;
  std::vector<double> forces(static_cast<std::size_t>(whole) + 2, 0);
  firmware_host::PlaceAndSpeed state{1, 0};
  double first = 0, second = 0;  // the largest energy in each half
  const int ticks = 200'000;
  for (int i = 0; i < ticks; ++i) {
    forces.insert(forces.begin(), -stiffness * state.place_m);
    forces.pop_back();
    for (const auto& [force, time_s] :
         {std::pair{forces.back(), late_s}, {forces.end()[-2], period_s - late_s}})
      state = firmware_host::LinearMotion{mass_kg, damping, 0, force, 0}.after(state, time_s);
    const double energy =
        stiffness * state.place_m * state.place_m + mass_kg * state.speed_mps * state.speed_mps;
    if (energy > 1e200) return false;
    double& largest = i < ticks / 2 ? first : second;
    if (i >= ticks / 4) largest = std::max(largest, energy);
  }
  return second < first;
}

TEST(FreeLimit, IsWhereTheMotionInTimeBeginsToGrow) {
  for (const double delay : {0.0, 0.5, 1.0, 2.25}) {
    const double limit = free_stiffness_limit(0.1, 30, 1e-3, delay);
    EXPECT_TRUE(returns(0.1, 30, 1e-3, delay, limit * (1 - 1e-6))) << delay;
    EXPECT_FALSE(returns(0.1, 30, 1e-3, delay, limit * (1 + 1e-6))) << delay;
  }
}

// 0.075 kg and 0.1 N s/m at 1 kHz with a delay of one tick (issue 33).
TEST(SampledSpring, VirtualDampingRaisesTheLimitAndThenMakesItUnstable) {
  const auto limit = [](double damping) { return stiffness_limit({0.075, 0.1, 0}, {1e-3, 1}, damping); };
  EXPECT_NEAR(limit(30), 10.8e3, 50);
  EXPECT_GT(limit(30), limit(5));
  EXPECT_EQ(limit(70), 0);
}

// Two ways to the same boundary, without and with delay, damper and hand; with bodies:
// design_command_test.py.
TEST(SampledLoop, WithoutBodiesIsStableUpToTheLimit) {
  for (const HeldMass& held : {HeldMass{0.1, 1, 0}, {0.8, 6.17, 400}, {1e-3, 0.01, 0}})
    for (const double delay : {0.0, 0.3, 1.0, 2.75, 20.0})
      for (const double damping : {0.0, 0.2}) {
        const TickTiming timing{1e-3, delay};
        const double limit = stiffness_limit(held, timing, damping);
        if (limit > 0) {
          EXPECT_TRUE(is_stable(held, timing, {limit * (1 - 1e-6), damping, {}})) << delay;
        }
        EXPECT_FALSE(is_stable(held, timing, {limit * (1 + 1e-6) + 1e-3, damping, {}})) << delay;
      }
}

// A body at rest is a spring to the ground. With a coupling above 4 mass / period^2 the swing of a body
// grows.
TEST(SampledLoop, ABodyThatMayRestHasToBeStableInBoth) {
  const HeldMass held{0.5, 2, 300};
  const TickTiming timing{1e-3, 0};
  CoupledBody body{0.3, 0, 800, 1, false};
  EXPECT_TRUE(is_stable(held, timing, {0, 0, {body}}));
  body.may_rest = true;
  const double limit = stiffness_limit(held, timing, 1);
  EXPECT_TRUE(is_stable(held, timing, {limit - 801, 0, {body}}));
  EXPECT_FALSE(is_stable(held, timing, {limit - 799, 0, {body}}));
  body.stiffness_n_per_m = 4 * 0.3 / 1e-6;
  EXPECT_FALSE(is_stable(held, timing, {0, 0, {body}}));
}

/// Whether Coulomb friction stops the free axis that is let go this far from the spring's centre.
bool comes_to_rest(const schema::DeviceAxis& axis, double period_s, double stiffness, double start_m) {
  const firmware_host::AxisBody body{axis.mass_kg, axis.viscous_n_s_per_m, axis.coulomb_n, 0, 0};
  firmware_host::PlaceAndSpeed state{start_m, 0};
  for (;;) {
    const auto next = firmware_host::moved(body, state, -stiffness * state.place_m, {}, period_s);
    if (next.speed_mps == 0 && next.place_m == state.place_m) return true;
    if (std::abs(next.place_m) > 2 * start_m) return false;
    state = next;
  }
}

// Within 1 % for w T <= 0.2 (issue 33): the describing function leaves out all harmonics of the friction.
TEST(FrictionBasin, IsTheAmplitudeUpToWhichTheAxisComesToRest) {
  schema::DeviceAxis axis;
  axis.mass_kg = 0.1;
  axis.viscous_n_s_per_m = 0.3;
  axis.coulomb_n = 0.05;
  for (const double stiffness : {1000.0, 2000.0, 4000.0}) {
    const double basin_m = friction_basin_m(axis, {1e-3, 0}, stiffness, 0);
    EXPECT_TRUE(comes_to_rest(axis, 1e-3, stiffness, 0.99 * basin_m)) << stiffness;
    EXPECT_FALSE(comes_to_rest(axis, 1e-3, stiffness, 1.01 * basin_m)) << stiffness;
  }
  EXPECT_TRUE(std::isinf(friction_basin_m(axis, {1e-3, 0}, 500, 0)));
}

}  // namespace
}  // namespace tacto::playback
