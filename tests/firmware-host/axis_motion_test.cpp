// SPDX-License-Identifier: GPL-3.0-or-later
// One axis of the emulated force device against closed forms: damped oscillation, ramps, braking by Coulomb
// friction, stick and slip of a mass that a spring pulls.
#include "firmware-host/sim/planar/axis_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace tacto::firmware_host {
namespace {

using Complex = std::complex<double>;

// x(t) of m x'' + b x' + k x = f + g t, by its two roots and the particular solution (f - b g / k + g t) / k.
PlaceAndSpeed closed_form(const LinearMotion& motion, PlaceAndSpeed start, double t) {
  const auto [m, b, k, f, g] = motion;
  const Complex root = std::sqrt(Complex(b * b / (4 * m * m) - k / m));
  const Complex r1 = -b / (2 * m) + root, r2 = -b / (2 * m) - root;
  const double at_0 = (f - b * g / k) / k, slope = g / k;
  const Complex x0 = start.place_m - at_0, v0 = start.speed_mps - slope;
  const Complex a1 = (v0 - r2 * x0) / (r1 - r2), a2 = (r1 * x0 - v0) / (r1 - r2);
  const Complex x = a1 * std::exp(r1 * t) + a2 * std::exp(r2 * t);
  const Complex v = a1 * r1 * std::exp(r1 * t) + a2 * r2 * std::exp(r2 * t);
  return {x.real() + at_0 + slope * t, v.real() + slope};
}

// Doubles: the closed form itself cancels to some 1e-13 of its parts where the two roots are near each other.
TEST(LinearMotion, IsTheClosedForm) {
  std::mt19937_64 random(16);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int draw = 0; draw < 300; ++draw) {
    const LinearMotion motion{std::exp(part(random)), 20 * (1 + part(random)),
                              400 * std::exp(2 * part(random)), part(random), 50 * part(random)};
    const PlaceAndSpeed start{0.01 * part(random), 0.2 * part(random)};
    const double t = 0.2 * (1 + part(random));
    const PlaceAndSpeed found = motion.after(start, t), expected = closed_form(motion, start, t);
    EXPECT_NEAR(found.place_m, expected.place_m, 1e-13) << draw;
    EXPECT_NEAR(found.speed_mps, expected.speed_mps, 1e-11) << draw;
  }
}

// Without a spring the closed form is that of the lag m / b; with one, only its slow root is left, because
// the fast one has decayed. A loop over the pieces would take 1e4 to 1e20 steps.
TEST(LinearMotion, ALightMassOnAStrongDamperFollowsItsForce) {
  constexpr double kTime = 2.5e-4, b = 0.5, k = 300;
  for (const double m : {1e-8, 1e-12, 1e-24}) {
    const double lag = m / b, steady = 3 / b - 5 / b * lag;
    const PlaceAndSpeed free = LinearMotion{m, b, 0, 3, 5}.after({0.1, -0.2}, kTime);
    EXPECT_NEAR(free.place_m, 0.1 + steady * kTime + 5 / b * kTime * kTime / 2 + (-0.2 - steady) * lag,
                1e-15);
    EXPECT_NEAR(free.speed_mps, steady + 5 / b * kTime, 1e-14);
    const double s = std::sqrt(b * b - 4 * k * m), slow = -2 * k / (b + s);
    const PlaceAndSpeed held = LinearMotion{m, b, k, 0, 0}.after({0.1, 0}, kTime);
    const double left = 0.1 * (b + s) / (2 * s) * std::exp(slow * kTime);
    EXPECT_NEAR(held.place_m, left, 1e-14);
    EXPECT_NEAR(held.speed_mps, slow * left, 1e-12);
  }
}

TEST(LinearMotion, ManyPiecesOfASwingKeepItsPhase) {
  const LinearMotion swing{0.5, 0.02, 400, 0.3, 1};
  for (const double t : {8.0, 10.0, 200.0}) {
    const PlaceAndSpeed found = swing.after({0.01, 0.2}, t), expected = closed_form(swing, {0.01, 0.2}, t);
    EXPECT_NEAR(found.place_m, expected.place_m, 1e-13) << t;
    EXPECT_NEAR(found.speed_mps, expected.speed_mps, 1e-11) << t;
  }
}

TEST(LinearMotion, AFreeMassUnderARampIsACubic) {
  const LinearMotion free{.mass_kg = 2, .force_n = 3, .force_rate_n_per_s = 5};
  const PlaceAndSpeed end = free.after({0.1, -0.2}, 0.7);
  EXPECT_NEAR(end.place_m, 0.1 - 0.2 * 0.7 + 3 * 0.49 / 4 + 5 * 0.343 / 12, 1e-15);
  EXPECT_NEAR(end.speed_mps, -0.2 + 3 * 0.7 / 2 + 5 * 0.49 / 4, 1e-15);
}

TEST(AxisMotion, CoulombFrictionBrakesAMassWithinItsDistance) {
  const AxisBody body{.mass_kg = 0.3, .coulomb_n = 0.6};
  const double stop_s = 0.5 * 0.3 / 0.6, distance_m = 0.5 * 0.5 * stop_s;
  const PlaceAndSpeed before = moved(body, {0, 0.5}, 0, {}, 0.999 * stop_s);
  EXPECT_GT(before.speed_mps, 0);
  for (const double after_s : {1.001, 2.0, 100.0}) {
    const PlaceAndSpeed end = moved(body, {0, 0.5}, 0, {}, after_s * stop_s);
    EXPECT_EQ(end.speed_mps, 0);
    EXPECT_NEAR(end.place_m, distance_m, 1e-15);
  }
}

TEST(AxisMotion, AForceWithinCoulombFrictionMovesNothing) {
  const AxisBody body{.mass_kg = 0.3, .coulomb_n = 0.6};
  EXPECT_EQ(moved(body, {0.1, 0}, 0.6, {}, 1).place_m, 0.1);
  const PlaceAndSpeed end = moved(body, {0.1, 0}, 0.61, {}, 1);
  EXPECT_NEAR(end.place_m - 0.1, 0.01 / 0.3 / 2, 1e-14);
}

// A hand pulls a resting mass evenly: it begins at c = k v t and then moves as v t - v sin(w t) / w, which
// comes to rest after each turn of w, at the edge of friction, and begins again.
TEST(AxisMotion, AMassOnAMovingSpringBreaksAwayAndSlips) {
  const AxisBody body{.mass_kg = 0.2, .coulomb_n = 0.4, .hand_stiffness_n_per_m = 500};
  const double speed_mps = 0.02, w = std::sqrt(500 / 0.2), break_s = 0.4 / (500 * speed_mps);
  for (const double slip_s : {0.3 / w, 2.0 / w, 5.0 / w, 30.0 / w}) {
    const PlaceAndSpeed end = moved(body, {}, 0, {0, speed_mps}, break_s + slip_s);
    EXPECT_NEAR(end.place_m, speed_mps * (slip_s - std::sin(w * slip_s) / w), 1e-10) << slip_s * w;
  }
  EXPECT_EQ(moved(body, {}, 0, {0, speed_mps}, 0.999 * break_s).place_m, 0);
}

// The decay of a spring's swing under Coulomb friction: each half swing loses 2 c / k, and it rests within c
// / k.
TEST(AxisMotion, AFreeSwingLosesTheSameInEachHalfSwing) {
  const AxisBody body{.mass_kg = 0.2, .coulomb_n = 0.5, .hand_stiffness_n_per_m = 500};
  const double half_s = std::numbers::pi / std::sqrt(500 / 0.2), loss_m = 2 * 0.5 / 500;
  PlaceAndSpeed state{0.0095, 0};
  for (int half = 1; half <= 4; ++half) {
    state = moved(body, state, 0, {}, half_s);
    EXPECT_NEAR(std::abs(state.place_m), 0.0095 - half * loss_m, 1e-12) << half;
    state.speed_mps = 0;
  }
  EXPECT_LE(std::abs(moved(body, {0.0095, 0}, 0, {}, 100).place_m), 0.5 * loss_m);
  EXPECT_EQ(moved(body, {0.0095, 0}, 0, {}, 100).speed_mps, 0);
}

// There is no step to choose: one call, or many short ones, end in the same state.
TEST(AxisMotion, DoesNotDependOnHowTheTimeIsDivided) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  for (int draw = 0; draw < 40; ++draw) {
    const AxisBody body{0.05 + part(random), 5 * part(random), part(random), 3 * part(random),
                        800 * part(random)};
    const double motor_n = 4 * part(random) - 2, duration_s = 0.4;
    const HandPlace hand{0.01 * part(random), 0.2 * part(random) - 0.1};
    const PlaceAndSpeed start{0, part(random) - 0.5};
    const PlaceAndSpeed whole = moved(body, start, motor_n, hand, duration_s);
    PlaceAndSpeed state = start;
    const int pieces = 1000;
    for (int i = 0; i < pieces; ++i) {
      const HandPlace later{hand.place_m + hand.speed_mps * duration_s * i / pieces, hand.speed_mps};
      state = moved(body, state, motor_n, later, duration_s / pieces);
    }
    EXPECT_NEAR(state.place_m, whole.place_m, 1e-10) << draw;
    EXPECT_NEAR(state.speed_mps, whole.speed_mps, 1e-8) << draw;
  }
}

}  // namespace
}  // namespace tacto::firmware_host
