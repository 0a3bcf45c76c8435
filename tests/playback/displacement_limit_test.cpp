// SPDX-License-Identifier: GPL-3.0-or-later
// The largest displacement of a program's tray, against the response's peak by brute force.
#include "playback/prepare/displacement_limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "data-schema/transducer/transducer.hpp"
#include "playback/prepare/prepare.hpp"
#include "tests/playback/made_textures.hpp"

namespace tacto::playback {
namespace {

constexpr double kLimitRateHz = 5e3, kForceN = 0.02, kLimitedGainMPerN = 5e-4;

schema::Transducer with_damping_ratio(double ratio) {
  schema::Transducer t = schema::read_transducer("wiertlewski2011").value();
  const double k = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
  t.damping_n_s_per_m = 2 * ratio * std::sqrt(k * t.mass_kg);
  return t;
}

// A response that is not inverted: the displacement is limited only by the resonance, with a held drive.
double brute_force_peak(const schema::Transducer& t, const Prepared& prepared) {
  double most = 0;
  for (double f = 0.01; f < prepared.stops_at_hz; f += 0.01) {
    const double turn = std::numbers::pi * f / kLimitRateHz;
    most = std::max(most, std::abs(schema::actuator_response(t, f)) * std::sin(turn) / turn);
  }
  const auto [least, largest] = std::ranges::minmax(prepared.samples);
  return most * double{prepared.taps.front()} * double{std::max(-least, largest)} * kLimitedGainMPerN;
}

TEST(DisplacementLimit, ReachesTheTopOfTheResonanceHoweverSharp) {
  PrepareOptions options;
  options.rate_hz = kLimitRateHz;
  options.inverse = Inverse::gain;
  options.gain_m_per_n = kLimitedGainMPerN;
  for (const double ratio : {0.5, 0.096, 0.03, 0.003, 0.0005}) {
    const schema::Transducer t = with_damping_ratio(ratio);
    const auto prepared = prepare(sine_texture(0.02, 1000, kForceN), t, options);
    ASSERT_TRUE(prepared);
    ASSERT_EQ(prepared->taps.size(), 1U);
    const double expected = brute_force_peak(t, *prepared);
    // Tolerance: 0.01 Hz beside the maximum of the sharpest resonance, 0.5 Hz wide: 0.1 %.
    EXPECT_NEAR(tray_peak_m(*prepared, t, options), expected, 2e-3 * expected) << "damping ratio " << ratio;
  }
}

// The gain in the message is accepted, and a thousandth more is refused.
TEST(DisplacementLimit, NamesAFactorThatFits) {
  schema::Transducer t = with_damping_ratio(0.096);
  for (const double limit_m : {3.33333e-6, 1.99999e-6, 7.77777e-6}) {
    t.displacement_limit_m = limit_m;
    const auto refused = check_displacement(10e-6, 1, kLimitedGainMPerN, kLimitedGainMPerN, t);
    ASSERT_FALSE(refused);
    const std::string& remedy = refused.error().remedy;
    const double factor = std::stod(remedy.substr(remedy.find("(") + 1));
    EXPECT_TRUE(check_displacement(10e-6, factor, kLimitedGainMPerN, kLimitedGainMPerN, t)) << remedy;
    EXPECT_TRUE(check_displacement(10e-6, -factor, kLimitedGainMPerN, kLimitedGainMPerN, t)) << remedy;
    EXPECT_FALSE(check_displacement(10e-6, 1.001 * factor, kLimitedGainMPerN, kLimitedGainMPerN, t))
        << remedy;
    EXPECT_FALSE(check_displacement(10e-6, -1.001 * factor, kLimitedGainMPerN, kLimitedGainMPerN, t))
        << remedy;
  }
}

}  // namespace
}  // namespace tacto::playback
