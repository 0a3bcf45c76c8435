// SPDX-License-Identifier: GPL-3.0-or-later
// The table of fidelity: the emulated transducer's displacement against the wanted one, for each texture
// named. Fails where the exact model (row a) is worse than -50 dB.
#include <fmt/format.h>

#include "firmware-host/sim/random.hpp"
#include "firmware-host/sim/spline_noise.hpp"
#include "tests/playback/fidelity.hpp"
#include "tests/playback/rayleigh_law.hpp"

namespace tacto::tests {
namespace {

using playback::FingerPath;

constexpr double kDurationS = 2.4;

FingerPath steady(double speed_mps) {
  return {{0, kDurationS}, {0.02, 0.02 + speed_mps * kDurationS}};
}

// 10 % of speed wander (RMS, below 2 Hz) about 60 mm/s, and three reversals.
FingerPath hand(bool reversing) {
  firmware_host::SplineNoise wander(firmware_host::Random(3, 1), 0.25);
  FingerPath path;
  double position_m = 0.05;
  for (int i = 0; i <= 2400; ++i) {
    const double time_s = kDurationS * i / 2400;
    path.time_s.push_back(time_s);
    path.position_m.push_back(position_m);
    const double way = reversing ? std::cos(2 * std::numbers::pi * time_s / 1.6) : 1;
    position_m += 0.06 * way * (1 + 0.1 * wander.at(time_s)) * kDurationS / 2400;
  }
  return path;
}

FidelityCase basic(double speed_mps, double rate_hz) {
  FidelityCase c;
  c.model = c.real = *schema::read_transducer("wiertlewski2011");
  c.options.rate_hz = rate_hz;
  c.options.metres_per_count = kTrueCountM;
  c.options.gain_m_per_n = 1e-4;
  c.path = steady(speed_mps);
  return c;
}

bool print_row(const schema::Texture& texture, const std::string& name, const FidelityCase& c,
               double bar_db = 1e9) {
  const auto fidelity = fidelity_of(texture, c);
  if (!fidelity) {
    fmt::print(stderr, "{}\n", message(fidelity.error()));
    return false;
  }
  fmt::print("| {} | {:.1f} | {:.4f} | {:.3f} |\n", name, fidelity->error_db, fidelity->error_um,
             fidelity->wanted_um);
  return fidelity->error_db <= bar_db;
}

bool exact_model(const schema::Texture& texture) {
  bool good = true;
  for (const double rate_hz : {2e3, 5e3, 10e3, 20e3})
    for (const double speed_mps : {0.025, 0.05, 0.1, 0.2})
      good = print_row(texture,
                       fmt::format("(a) exact model, {:g} mm/s, {:g} kHz", 1e3 * speed_mps, 1e-3 * rate_hz),
                       basic(speed_mps, rate_hz), -50) &&
             good;
  FidelityCase filtered = basic(0.05, 2e3);
  filtered.options.reconstruction = playback::Reconstruction::butterworth3;
  return print_row(texture, "(a) with the 600 Hz filter, 50 mm/s, 2 kHz", filtered, -50) && good;
}

void worse_position(const schema::Texture& texture) {
  for (const double rate_hz : {2e3, 10e3})
    for (const double speed_mps : {0.0263, 0.0517, 0.1031, 0.1973, 0.025, 0.05, 0.1, 0.2}) {
      FidelityCase c = basic(speed_mps, rate_hz);
      c.options.metres_per_count = 1e-6;
      print_row(texture,
                fmt::format("(b) 1 um encoder, {:g} mm/s, {:g} kHz", 1e3 * speed_mps, 1e-3 * rate_hz), c);
    }
  for (const bool reversing : {false, true})
    for (const double count_m : {kTrueCountM, 1e-6}) {
      FidelityCase c = basic(0.06, 2e3);
      c.path = hand(reversing);
      c.options.metres_per_count = count_m;
      print_row(texture,
                fmt::format("(c) {}, {}", reversing ? "reversals and 10 % of wander" : "10 % of wander",
                            count_m < 1e-8 ? "true position" : "1 um encoder"),
                c);
    }
}

void worse_model(const schema::Texture& texture) {
  struct Parameter {
    const char* name;
    double schema::Transducer::*value;
  };
  const Parameter parameters[] = {{"stiffness", &schema::Transducer::bender_stiffness_n_per_m},
                                  {"mass", &schema::Transducer::mass_kg},
                                  {"damping", &schema::Transducer::damping_n_s_per_m},
                                  {"capacitance", &schema::Transducer::capacitance_f},
                                  {"gain", &schema::Transducer::actuator_scale}};
  for (const auto& [name, value] : parameters) {
    FidelityCase c = basic(0.05, 2e3);
    c.real.*value *= 1.05;
    print_row(texture, fmt::format("(d) {} 5 % off, 50 mm/s, 2 kHz", name), c);
  }
}

void worse_physics(const schema::Texture& texture) {
  FidelityCase c = basic(0.05, 2e3);
  c.physics.finger_load.emplace();
  print_row(texture, "(f) a finger's load, 50 mm/s, 2 kHz", c);
  c.physics.second_mode.emplace();
  print_row(texture, "(f) a finger's load and the second mode, 50 mm/s, 2 kHz", c);
}

// 0.1 mm/N moves the bender by a hundredth of its range, 1 mm/N by a tenth.
void hysteresis(const schema::Texture& texture) {
  for (const double gain_m_per_n : {1e-4, 1e-3})
    for (const double known : {0.0, 0.16, 0.14})
      for (const double rate_hz : {2e3, 10e3}) {
        FidelityCase c = basic(0.05, rate_hz);
        c.options.gain_m_per_n = gain_m_per_n;
        c.physics.hysteresis = 0.16;
        if (known > 0) c.model.hysteresis = playback::rayleigh(known, c.model.drive_limit_v, wire::kMaxPlays);
        const std::string how = known > 0 ? fmt::format("undone as {:g} %", 100 * known) : "not undone";
        print_row(texture,
                  fmt::format("(e) hysteresis of 16 %, {}, {:g} mm/N, 50 mm/s, {:g} kHz", how,
                              1e3 * gain_m_per_n, 1e-3 * rate_hz),
                  c);
      }
}

bool print_table(const char* name) {
  const auto texture = schema::read_texture(name);
  if (!texture) {
    fmt::print(stderr, "{}\n", message(texture.error()));
    return false;
  }
  fmt::print("\n| {} | error, dB | error, um | wanted, um |\n|---|---|---|---|\n", name);
  const bool good = exact_model(*texture);
  worse_position(*texture);
  worse_model(*texture);
  hysteresis(*texture);
  worse_physics(*texture);
  return good;
}

}  // namespace
}  // namespace tacto::tests

int main(int count, char** names) {
  bool good = count > 1;
  for (int i = 1; i < count; ++i) good = tacto::tests::print_table(names[i]) && good;
  return good ? 0 : 1;
}
