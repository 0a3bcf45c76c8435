// SPDX-License-Identifier: GPL-3.0-or-later
// Second mode, finger's load and hysteresis on the tray, against closed forms.
#include "firmware-host/sim/physics/tray_physics.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "firmware-host/open_device.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "firmware-host/sim/bench/force_bench.hpp"
#include "firmware-host/sim/device/sim_device.hpp"
#include "tests/firmware-host/sim_stream.hpp"
#include "tests/firmware-host/sine_fit.hpp"

namespace tacto::firmware_host {
namespace {

using Complex = std::complex<double>;
constexpr double kPhysicsTickHz = 20e3, kTurn = 2 * std::numbers::pi;

const schema::Transducer& paper_tray() {
  static const schema::Transducer kPreset = *schema::read_transducer("wiertlewski2011");
  return kPreset;
}
double stiffness() {
  return paper_tray().flexure_stiffness_n_per_m + paper_tray().bender_stiffness_n_per_m;
}

// The spring that gives the undamped two masses a natural frequency at w, by bisection, independently of the
// code.
double inner_spring_n_per_m(const SecondMode& mode) {
  const double inner_kg = mode.mass_share * paper_tray().mass_kg, outer_kg = paper_tray().mass_kg - inner_kg;
  const double w2 = std::pow(kTurn * mode.frequency_hz, 2);
  const auto determinant = [&](double k2) {
    return (stiffness() + k2 - outer_kg * w2) * (k2 - inner_kg * w2) - k2 * k2;
  };
  double low = 0, high = inner_kg * w2;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    ((determinant(middle) > 0) == (determinant(low) > 0) ? low : high) = middle;
  }
  return low;
}

// Displacement per force, by Cramer's rule; relative to the plain tray's.
Complex two_mass_ratio(const SecondMode& mode, double frequency_hz) {
  const Complex s(0, kTurn * frequency_hz);
  const double inner_kg = mode.mass_share * paper_tray().mass_kg, outer_kg = paper_tray().mass_kg - inner_kg;
  const double spring = inner_spring_n_per_m(mode);
  const double damper = 2 * mode.damping_ratio * std::sqrt(spring * inner_kg);
  const Complex link = spring + damper * s, own = paper_tray().damping_n_s_per_m * s + stiffness();
  const Complex inner = inner_kg * s * s + link;
  return (paper_tray().mass_kg * s * s + own) * inner /
         ((outer_kg * s * s + own + link) * inner - link * link);
}

Complex loaded_ratio(const FingerLoad& load, double frequency_hz) {
  const Complex s(0, kTurn * frequency_hz);
  const Complex plain = paper_tray().mass_kg * s * s + paper_tray().damping_n_s_per_m * s + stiffness();
  const double spring = 1 / load.compliance_m_per_n;
  return plain / (plain + load.mass_share * paper_tray().mass_kg * s * s +
                  spring / (kTurn * load.corner_hz) * s + spring);
}

// The response at the ticks to a held sine, with all images aliased onto it (as in actuated_tray_test).
template <class Ratio>
Complex folded(double frequency_hz, Ratio&& ratio) {
  Complex sum;
  for (int image = -100; image <= 100; ++image) {
    const double f = frequency_hz + image * kPhysicsTickHz, turns = f / kPhysicsTickHz;
    sum += std::polar(std::sin(std::numbers::pi * turns) / (std::numbers::pi * turns),
                      -std::numbers::pi * turns) *
           schema::actuator_response(paper_tray(), f) * ratio(f);
  }
  return sum;
}

Complex measured(double frequency_hz, const TrayPhysics& physics) {
  ActuatedTray tray(paper_tray(), kPhysicsTickHz, physics);
  std::vector<double> drive_v;
  for (int i = 0; i < 20000; ++i) drive_v.push_back(2 * std::cos(kTurn * frequency_hz * i / kPhysicsTickHz));
  const auto displacement_m = displacement_under(tray, drive_v);
  return tests::sine_fit(std::span(displacement_m).subspan(12000), 12000, kPhysicsTickHz, frequency_hz) / 2.0;
}

class PhysicsSine : public testing::TestWithParam<double> {};

// Tolerances as in actuated_tray_test; the second mode is sharper (0.03), and its ringing has decayed after
// 0.6 s.
TEST_P(PhysicsSine, TheSecondModeInTheActuatorIsTheClosedForm) {
  const SecondMode mode;
  const auto target = folded(GetParam(), [&](double f) { return two_mass_ratio(mode, f); });
  EXPECT_NEAR(std::abs(measured(GetParam(), {.second_mode = mode, .finger_load = {}}) / target - 1.0), 0,
              1e-5);
}

TEST_P(PhysicsSine, AFingersLoadIsTheClosedForm) {
  const FingerLoad load;
  const auto target = folded(GetParam(), [&](double f) { return loaded_ratio(load, f); });
  EXPECT_NEAR(std::abs(measured(GetParam(), {.second_mode = {}, .finger_load = load}) / target - 1.0), 0,
              1e-5);
}

TEST_P(PhysicsSine, TheSecondModeInTheSensorIsTheClosedForm) {
  const SecondMode mode;
  ForceBench bench(
      paper_tray(),
      {.shape = ForceShape::sine, .amplitude_n = 0.1, .low_hz = GetParam(), .high_hz = GetParam()},
      kPhysicsTickHz, mode);
  std::vector<double> output_v;
  for (int i = 0; i < 20000; ++i) {
    bench.step({}, 0);
    output_v.push_back(bench.reading().sensor_v);
  }
  const auto seen = tests::sine_fit(std::span(output_v).subspan(12000), 12001, kPhysicsTickHz, GetParam());
  const auto target = schema::sensor_response(paper_tray(), GetParam()) * two_mass_ratio(mode, GetParam());
  EXPECT_NEAR(std::abs(seen / (Complex(0, -0.1) * target) - 1.0), 0, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Band, PhysicsSine, testing::Values(10, 100, 300, 500, 650, 800, 1000));

double peak_hz(double from_hz, double to_hz, const SecondMode& mode) {
  double best = from_hz;
  const auto size = [&](double f) {
    return std::abs(two_mass_ratio(mode, f) * schema::actuator_response(paper_tray(), f));
  };
  for (double f = from_hz; f <= to_hz; f += 0.1)
    if (size(f) > size(best)) best = f;
  return best;
}

// As in the paper: "a small un-modeled resonance at 800 Hz" above one at 500 Hz, which is at 548 Hz by Table
// I alone. The static gain does not change.
TEST(TrayPhysics, TheModesLieWhereThePaperSawThem) {
  const SecondMode mode;
  EXPECT_NEAR(peak_hz(400, 600, mode), 500, 10);
  EXPECT_NEAR(peak_hz(700, 900, mode), 800, 10);
  ActuatedTray tray(paper_tray(), 10e3, {.second_mode = mode, .finger_load = {}});
  for (int i = 0; i < 5000; ++i) tray.tick(1);
  EXPECT_NEAR(tray.displacement_m(), schema::actuator_response(paper_tray(), 0).real(), 1e-14);
}

// "Finger tip causes a 3 dB attenuation of the resonant peak" (section III-B).
TEST(TrayPhysics, AFingerTakesThreeDecibelsOffTheResonance) {
  const auto peak = [](auto&& ratio) {
    double best = 0;
    for (double f = 400; f < 650; f += 0.5)
      best = std::max(best, std::abs(ratio(f) * schema::actuator_response(paper_tray(), f)));
    return best;
  };
  const FingerLoad load;
  const double loaded = peak([&](double f) { return loaded_ratio(load, f); });
  EXPECT_NEAR(20 * std::log10(peak([](double) { return 1.0; }) / loaded), 3, 0.3);
}

// A slow sine of the full drive, as in the paper's Figure 7. In addition, the amplifier's low-pass lags by
// 0.2 Hz over 143 Hz, and the held drive by half a tick; where the loop is widest its slope is 1, within the
// step of the play operators, 1/32.
TEST(TrayPhysics, TheDrivenLoopOpensByWhatIsAsked) {
  constexpr double kSlowHz = 0.2, kRate = 1e3, kLoopOpening = 0.16;
  ActuatedTray tray(paper_tray(), kRate, {.second_mode = {}, .finger_load = {}, .hysteresis = kLoopOpening});
  std::vector<double> drive_v, x_m;
  for (int i = 0; i < 15000; ++i) drive_v.push_back(5 * std::sin(kTurn * kSlowHz * i / kRate));
  x_m = displacement_under(tray, drive_v);
  const std::span last = std::span(x_m).subspan(10000, 5000);
  const auto [low, high] = std::ranges::minmax(last);
  const double opening = (last[2500] - last[0]) / (high - low);
  const double lag_rad = kSlowHz / 143 + std::numbers::pi * kSlowHz / kRate;
  EXPECT_NEAR(opening, kLoopOpening + lag_rad, 3e-4);
  EXPECT_NEAR(high - low, 10 * schema::actuator_response(paper_tray(), 0).real(), 1e-3 * (high - low));
  // The fundamental of Rayleigh's loop lags by atan(8 h / 3 pi): 7.7 degrees for 16 %; the paper reports 8.
  const auto fundamental = tests::sine_fit(last, 10000, kRate, kSlowHz);
  EXPECT_NEAR(std::arg(Complex(0, -1) / fundamental),
              std::atan(8 * kLoopOpening / (3 * std::numbers::pi)) + lag_rad, 1e-3);
}

// Displacement of the emulated device's tray for a drive of 2 V from the host.
double driven_m(const std::string& parameters) {
  auto device = make_sim_device("sim:" + parameters, parameters);
  if (!device) throw std::runtime_error(message(device.error()));
  Client& client = (*device)->client();
  const auto& about = client.description().welcome;
  const wire::Limits limits{about.drive_limit_v, about.slew_limit_v_per_s, 0.001F, 0.001F, 1000, 100};
  wire::Drive drive;
  drive.count = wire::kMaxChunk;
  std::fill(std::begin(drive.drive_v), std::end(drive.drive_v), 2.0F);
  const bool playing = client.command(limits) &&
                       client.command(wire::Arm{wire::DriveSource::host, 10'000'000}) &&
                       client.send_drive(drive) && client.send_drive(drive) && client.command(wire::Play{});
  if (!playing) throw std::runtime_error("does not play");
  const double until_s = client.transport().now_s() + 0.08;
  while (client.transport().now_s() < until_s)
    if (!client.receive(0.01)) throw std::runtime_error("is gone");
  return (*device)->board().displacement_m();
}

TEST(TrayPhysics, TheDevicesTrayHasWhatItsParametersSay) {
  const double plain_m = driven_m("surface=C");
  EXPECT_NEAR(plain_m, 2 * schema::actuator_response(paper_tray(), 0).real(), 1e-4 * plain_m);
  EXPECT_NEAR(driven_m("surface=C,finger_load=on") / plain_m, stiffness() / (stiffness() + 1000), 1e-4);
  EXPECT_NEAR(driven_m("surface=C,second_mode=800Hz") / plain_m, 1, 1e-4);
  // The virgin curve at 2 V of 5 V: 1 - 2 h + 2 h s of the straight line.
  EXPECT_NEAR(driven_m("surface=C,hysteresis=0.16") / plain_m, 1 - 0.32 + 0.32 * 0.4, 1e-3);
}

TEST(TrayPhysics, TheDevicesSensorHasTheSecondMode) {
  const std::string force = "sim:noise=off,force=sine,force_low=800Hz,force_amplitude=10mN";
  const auto size = [&](const std::string& more) {
    const auto volts = tests::stream_of(force + more, 0.6).channel(tests::kSensor);
    return std::abs(tests::sine_fit(std::span(volts).subspan(2000), 2001, 10e3, 800));
  };
  // tolerance: 16 bits for a tone of 0.1 V, 3e-4
  EXPECT_NEAR(size(",second_mode=800Hz") / size(""), std::abs(two_mass_ratio({}, 800)), 2e-3);
}

TEST(TrayPhysics, TheDeviceSaysWhatItHas) {
  const auto device = open_device("sim:hysteresis=0.16,second_mode=800Hz,finger_load=on,position=lvdt");
  ASSERT_TRUE(device) << message(device.error());
  const std::string& said = (*device)->capabilities().simulated;
  for (const char* part : {"second mode at 800 Hz", "16 % of hysteresis", "finger's load", "LVDT"})
    EXPECT_NE(said.find(part), std::string::npos) << said;
}

}  // namespace
}  // namespace tacto::firmware_host
