// SPDX-License-Identifier: GPL-3.0-or-later
// The integrated sensor against the closed form of its transfer function.
#include <gtest/gtest.h>

#include <vector>

#include "firmware-host/sim/physics/runge_kutta.hpp"
#include "firmware-host/sim/physics/sensor_motion.hpp"
#include "tests/firmware-host/sine_fit.hpp"

namespace tacto::firmware_host {
namespace {

constexpr double kSensorStepS = 12.5e-6;  // as in TouchBench at 10 kHz
constexpr double kSensorRateHz = 1 / kSensorStepS;

schema::Transducer paper_sensor() {
  return *schema::read_transducer("wiertlewski2011");
}

OdeState<5> as_array(const SensorState& s) {
  return {s.tray_m, s.tray_mps, s.charge_lag_n, s.inner_m, s.inner_mps};
}
SensorState as_state(const OdeState<5>& s) {
  return {s[0], s[1], s[2], s[3], s[4]};
}

// State after every step under force(time).
template <class Force>
std::vector<SensorState> integrate(const SensorMotion& sensor, SensorState start, std::size_t steps,
                                   Force&& force) {
  std::vector<SensorState> states;
  OdeState<5> state = as_array(start);
  for (std::size_t i = 0; i < steps; ++i) {
    states.push_back(as_state(state));
    state = runge_kutta_step(state, kSensorStepS, [&](const OdeState<5>& s, double part) {
      return as_array(sensor.rate(as_state(s), force((static_cast<double>(i) + part) * kSensorStepS)));
    });
  }
  return states;
}

class SensorSine : public testing::TestWithParam<double> {};

// The step's error is 4e-7 of a radian's phase at 800 Hz ((w h)^4 / 120), multiplied by the resonance (Q =
// 5); after 0.4 s the transient of the 20 ms high-pass is e^-20.
TEST_P(SensorSine, GainAndPhaseAreTheClosedForm) {
  const double frequency_hz = GetParam();
  const SensorMotion sensor(paper_sensor());
  const auto states = integrate(
      sensor, {}, 48000, [&](double t) { return 0.1 * std::cos(2 * std::numbers::pi * frequency_hz * t); });
  std::vector<double> output_v;
  for (const SensorState& state : states) output_v.push_back(sensor.output_v(state));
  constexpr std::size_t kSettled = 32000;  // 0.4 s; then 0.2 s, whole periods of all frequencies here
  const auto measured =
      tests::sine_fit(std::span(output_v).subspan(kSettled), kSettled, kSensorRateHz, frequency_hz) / 0.1;
  const auto expected = schema::sensor_response(paper_sensor(), frequency_hz);
  EXPECT_NEAR(std::abs(measured / expected), 1, 1e-5);
  EXPECT_NEAR(std::arg(measured / expected), 0, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Band, SensorSine, testing::Values(10, 15, 30, 100, 300, 500, 545, 600, 800));

// The released tray oscillates at w0 sqrt(1 - zeta^2) and decays with e^(-zeta w0 t), measured from its zero
// crossings and peaks.
TEST(SensorMotion, FreeDecayHasTheFrequencyAndDampingOfTheMechanics) {
  const schema::Transducer t = paper_sensor();
  const double stiffness = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
  const double w0 = std::sqrt(stiffness / t.mass_kg);
  const double zeta = t.damping_n_s_per_m / (2 * std::sqrt(stiffness * t.mass_kg));
  const auto states = integrate(SensorMotion(t), {.tray_m = 1e-6}, 1600, [](double) { return 0.0; });
  std::vector<double> crossings_s, peaks_m;
  for (std::size_t i = 1; i < states.size(); ++i) {
    const double before = states[i - 1].tray_m, after = states[i].tray_m;
    if (before > 0 && after <= 0)
      crossings_s.push_back((static_cast<double>(i - 1) + before / (before - after)) * kSensorStepS);
    if (states[i - 1].tray_mps > 0 && states[i].tray_mps <= 0) peaks_m.push_back(std::max(before, after));
  }
  ASSERT_GE(crossings_s.size(), 8U);
  const double period_s = (crossings_s[7] - crossings_s[0]) / 7;
  EXPECT_NEAR(2 * std::numbers::pi / period_s, w0 * std::sqrt(1 - zeta * zeta), 1e-4 * w0);
  const double decrement = std::log(peaks_m[0] / peaks_m[5]) / 5;
  const double expected = 2 * std::numbers::pi * zeta / std::sqrt(1 - zeta * zeta);
  EXPECT_NEAR(decrement, expected, 2e-3 * expected);  // a peak is read to (w h)^2 / 8 = 2e-4 of its height
}

TEST(SensorMotion, AConstantForceFadesBehindTheHighPass) {
  const SensorMotion sensor(paper_sensor());
  const auto states = integrate(sensor, {}, 40000, [](double) { return 0.2; });
  EXPECT_NEAR(states.back().tray_m, 0.2 / (76470 + 4050), 1e-12);
  EXPECT_NEAR(sensor.output_v(states.back()), 0, 1e-9);
}

}  // namespace
}  // namespace tacto::firmware_host
