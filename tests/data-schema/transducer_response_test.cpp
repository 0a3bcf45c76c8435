// SPDX-License-Identifier: GPL-3.0-or-later
// The responses against the figures recomputed from the paper, and against the equations of motion integrated
// in time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {
namespace {

constexpr double kPi = std::numbers::pi;

Transducer preset(const char* name) {
  return read_transducer(name).value();
}

double decibels(double ratio) {
  return 20 * std::log10(ratio);
}

double actuator_db(double frequency_hz) {
  const Transducer t = preset("wiertlewski2011");
  return decibels(std::abs(actuator_response(t, frequency_hz)) / std::abs(actuator_response(t, 0)));
}

// x, dx/dt and the voltage behind the resistor of the current stage.
using State = std::array<double, 3>;

// Integrates the paper's equations (1) to (6) for `input` (volts at the amplifier, or newtons on the tray) =
// a cosine of amplitude 1, without any transfer function.
struct Motion {
  Transducer t;
  double frequency_hz;
  bool sensing;

  State derivative(double time_s, const State& y) const {
    const double input = std::cos(2 * kPi * frequency_hz * time_s);
    const double beta = t.deflection_m / (2 * t.max_voltage_v);
    const double force = sensing ? input : 2 * beta * t.bender_stiffness_n_per_m * y[2];
    const double stiffness = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
    const double acceleration = (force - t.damping_n_s_per_m * y[1] - stiffness * y[0]) / t.mass_kg;
    const double resistance = sensing ? t.sensor_resistance_ohm : t.amplifier_resistance_ohm;
    const double source =
        sensing ? 2 * resistance * t.bender_stiffness_n_per_m * beta * y[1] : t.amplifier_gain * input;
    return {y[1], acceleration, (source - y[2]) / (2 * resistance * t.capacitance_f)};
  }

  State advanced(double time_s, const State& y, double step_s) const {
    const auto moved = [&](const State& slope, double h) {
      return State{y[0] + h * slope[0], y[1] + h * slope[1], y[2] + h * slope[2]};
    };
    const State a = derivative(time_s, y), b = derivative(time_s + step_s / 2, moved(a, step_s / 2));
    const State c = derivative(time_s + step_s / 2, moved(b, step_s / 2)),
                d = derivative(time_s + step_s, moved(c, step_s));
    State sum{};
    for (std::size_t i = 0; i < 3; ++i) sum[i] = (a[i] + 2 * b[i] + 2 * c[i] + d[i]) / 6;
    return moved(sum, step_s);
  }

  // After 0.5 s the slowest transient (the sensor's high-pass, 20 ms) has fallen to e^-25.
  std::complex<double> response() const {
    const double step_s = 1e-5, settle_s = 0.5;
    const auto periods = static_cast<int>(std::round(settle_s * frequency_hz));
    const auto steps_a_period = static_cast<int>(std::round(1 / (frequency_hz * step_s)));
    const double h = 1 / (frequency_hz * steps_a_period);
    State y{};
    std::complex<double> sum = 0;
    for (int i = 0; i < (periods + 1) * steps_a_period; ++i) {
      const double time_s = i * h;
      const double output = sensing ? -t.sensor_gain * t.sensor_scale * y[2] : t.actuator_scale * y[0];
      if (i >= periods * steps_a_period) sum += output * std::polar(1.0, -2 * kPi * frequency_hz * time_s);
      y = advanced(time_s, y, h);
    }
    return 2.0 * sum / static_cast<double>(steps_a_period);
  }
};

TEST(TransducerResponse, HasTheRecomputedResonanceAndPoles) {
  const Transducer t = preset("wiertlewski2011");
  EXPECT_NEAR(resonance_hz(t), 547.7, 0.05);  // tolerances: half of the last digit (CONTRIBUTING.md)
  EXPECT_NEAR(damping_ratio(t), 0.096, 0.0005);
  EXPECT_NEAR(actuator_pole_hz(t), 143, 0.5);
  EXPECT_NEAR(sensor_pole_hz(t), 8.1, 0.05);
  Transducer free = t;
  free.flexure_stiffness_n_per_m = 0;
  EXPECT_NEAR(resonance_hz(free), 533.7, 0.05);
  EXPECT_NEAR(damping_ratio(free), 0.098, 0.0005);
}

TEST(TransducerResponse, ActuatorFallsAndPeaksAsRecomputed) {
  EXPECT_NEAR(actuator_db(100), -1.4, 0.05);
  EXPECT_NEAR(actuator_db(300), -4.3, 0.05);
  EXPECT_NEAR(actuator_db(530), 2.5, 0.05);
  EXPECT_NEAR(actuator_db(800), -16, 0.5);
}

TEST(TransducerResponse, SensorIsLevelOnlyInItsMiddle) {
  const Transducer t = preset("wiertlewski2011");
  const auto relative = [&](double hz) {
    return std::abs(sensor_response(t, hz)) / std::abs(sensor_response(t, 100));
  };
  EXPECT_NEAR(relative(20), 0.9, 0.01);
  EXPECT_NEAR(relative(300), 1.4, 0.05);
  EXPECT_NEAR(relative(500), 4.0, 0.25);
}

TEST(TransducerResponse, TheoryGivesThePrintedGains) {
  Transducer t = preset("wiertlewski2011-as-printed");
  EXPECT_NEAR(std::abs(actuator_response(t, 0)) * 1e6, 8.2, 0.05);
  t.actuator_scale = 1;  // both betas
  EXPECT_NEAR(std::abs(actuator_response(t, 0)) * 1e6, 16.5, 0.05);
  t.flexure_stiffness_n_per_m = 4.05e3;
  EXPECT_NEAR(std::abs(actuator_response(t, 0)) * 1e6, 15.6, 0.05);
  // The sensor's pass-band in the sense of the paper: stiffness only, far above the high-pass and far below
  // resonance.
  t.flexure_stiffness_n_per_m = 0;
  t.mass_kg = t.damping_n_s_per_m = 1e-9;
  EXPECT_NEAR(std::abs(sensor_response(t, 1000)), 50.3, 0.05);
}

TEST(TransducerResponse, PresetHasTheReportedGains) {
  const Transducer t = preset("wiertlewski2011");
  EXPECT_NEAR(std::abs(actuator_response(t, 0)) / 20e-6, 1, 1e-12);  // the scales carry 17 digits
  EXPECT_NEAR(std::abs(sensor_response(t, 100)) / 26, 1, 1e-12);
}

TEST(TransducerResponse, NominalForceKeepsTheSensorsSign) {
  const Transducer t = preset("wiertlewski2011");
  const double newtons_per_volt = nominal_newtons_per_volt(t);
  EXPECT_LT(newtons_per_volt, 0);
  // |H_s| is 26 V/N there; its phase differs from half a turn by the high-pass's lead (4.6 degrees) and the
  // mechanics' lag.
  EXPECT_NEAR(newtons_per_volt, -1 / 26.0, 0.01 / 26.0);
}

TEST(TransducerResponse, EqualsTheEquationsOfMotionInTime) {
  for (const double frequency_hz : {20.0, 100.0, 300.0, 540.0, 800.0}) {
    const Transducer t = preset("wiertlewski2011");
    const auto actuator = Motion{t, frequency_hz, false}.response();
    const auto sensor = Motion{t, frequency_hz, true}.response();
    // Runge-Kutta of order 4 at 10 us: its error, (w h)^4 / 120 per radian at 800 Hz, is below 1e-6.
    EXPECT_LT(std::abs(actuator / actuator_response(t, frequency_hz) - 1.0), 1e-5) << frequency_hz;
    EXPECT_LT(std::abs(sensor / sensor_response(t, frequency_hz) - 1.0), 1e-5) << frequency_hz;
  }
}

// A mass on its own spring, undamped so that the poles have closed forms; by Newton: x (m_1 s^2 + k + m_2 s^2
// k_2 / (m_2 s^2 + k_2)) = f.
TEST(TransducerResponse, ASecondModeIsAMassOnASpring) {
  Transducer t = preset("wiertlewski2011");
  const double k = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
  const double inner_kg = 1e-3, inner_n_per_m = 2e4, tray_kg = t.mass_kg;
  const double sum = (k + inner_n_per_m) / tray_kg + inner_n_per_m / inner_kg;
  const double product = k * inner_n_per_m / (tray_kg * inner_kg);
  const double root = std::sqrt(sum * sum / 4 - product);
  const double low = std::sqrt(sum / 2 - root), high = std::sqrt(sum / 2 + root);
  t.damping_n_s_per_m = 1e-9;
  Transducer two = t;
  two.mass_kg = k / (low * low);
  two.second_mode =
      ModeAbove{high / (2 * kPi), 1e-12, std::sqrt(inner_n_per_m / inner_kg) / (2 * kPi), 1e-12};
  for (const double hz : {10.0, 300.0, 650.0, 800.0, 1500.0}) {
    const std::complex<double> s(0, 2 * kPi * hz);
    const auto tray = tray_kg * s * s + k, inner = inner_kg * s * s;
    const auto exact = (inner + inner_n_per_m) / (tray * (inner + inner_n_per_m) + inner * inner_n_per_m);
    const auto one = actuator_response(t, hz) * (t.mass_kg * s * s + k);  // everything except the mechanics
    EXPECT_LT(std::abs(actuator_response(two, hz) / (one * exact) - 1.0), 1e-6) << hz;
  }
}

TEST(TransducerResponse, ButterworthIsTheTextbooks) {
  EXPECT_NEAR(decibels(std::abs(butterworth3_response(600, 500))), -1.25, 0.005);
  EXPECT_NEAR(std::abs(butterworth3_response(600, 0)), 1, 1e-15);
  for (const double hz : {10.0, 600.0, 3000.0}) {
    const double magnitude = 1 / std::sqrt(1 + std::pow(hz / 600, 6));
    EXPECT_NEAR(std::abs(butterworth3_response(600, hz)) / magnitude, 1, 1e-14);
  }
  EXPECT_NEAR(std::arg(butterworth3_response(600, 600)), -3 * kPi / 4, 1e-14);
}

}  // namespace
}  // namespace tacto::schema
