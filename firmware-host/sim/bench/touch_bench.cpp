// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/bench/touch_bench.hpp"

#include <cmath>

namespace tacto::firmware_host {
namespace {

enum : std::size_t {
  kPulpM,
  kPulpMps,
  kBristleM,
  kBenchTrayM,
  kBenchTrayMps,
  kChargeLagN,
  kBenchInnerM,
  kBenchInnerMps
};

SensorState sensor_part(const OdeState<8>& s) {
  return {s[kBenchTrayM], s[kBenchTrayMps], s[kChargeLagN], s[kBenchInnerM], s[kBenchInnerMps]};
}

}  // namespace

TouchBench::TouchBench(const schema::Transducer& transducer, const FingerParameters& finger,
                       const HeightProfile& profile, double sample_rate_hz, double start_m,
                       std::uint64_t seed, const std::optional<SecondMode>& second_mode)
    : finger_(finger),
      sensor_(transducer, second_mode),
      ridges_(finger, profile, seed),
      period_s_(1 / sample_rate_hz),
      substeps_(substeps_in(period_s_)) {
  state_[kPulpM] = start_m;
}

double TouchBench::tray_force_n(const State& s, double load_n, double& bristle_rate_mps) {
  const LugreFriction friction = lugre_friction(finger_, s[kBristleM], s[kPulpMps] - s[kBenchTrayMps]);
  bristle_rate_mps = friction.bristle_rate_mps;
  return friction.coefficient * load_n + ridges_.slope_force_n(s[kPulpM] - s[kBenchTrayM], load_n);
}

TouchBench::State TouchBench::rate(const State& s, const Drag& bone) {
  double bristle_rate_mps = 0;
  const double force_n = tray_force_n(s, bone.load_n, bristle_rate_mps);
  const double pull_n = finger_.stiffness_n_per_m * (bone.position_m - s[kPulpM]) +
                        finger_.damping_n_s_per_m * (bone.speed_mps - s[kPulpMps]);
  const SensorState sensor = sensor_.rate(sensor_part(s), force_n);
  return {s[kPulpMps],      (pull_n - force_n) / finger_.mass_kg,
          bristle_rate_mps, sensor.tray_m,
          sensor.tray_mps,  sensor.charge_lag_n,
          sensor.inner_m,   sensor.inner_mps};
}

bool TouchBench::sane(const State& s, double bone_m) const {
  double sum = 0;
  for (const double value : s) sum += value;
  return std::isfinite(sum) && std::abs(s[kPulpM] - bone_m) < finger_.patch_m;
}

bool TouchBench::step(const FingerPlace& bone, double load_n) {
  const double h = period_s_ / substeps_;
  State state = state_;
  for (int i = 0; i < substeps_; ++i) {
    const double start_m = bone.position_m - bone.speed_mps * h * (substeps_ - i);
    state = runge_kutta_step(state, h, [&](const State& s, double part) {
      return rate(s, {start_m + bone.speed_mps * h * part, bone.speed_mps, load_n});
    });
  }
  if (!sane(state, bone.position_m)) return false;
  state_ = state;
  double bristle_rate_mps = 0;
  reading_ = {sensor_.output_v(sensor_part(state)), tray_force_n(state, load_n, bristle_rate_mps), load_n,
              bone.position_m};
  return true;
}

}  // namespace tacto::firmware_host
