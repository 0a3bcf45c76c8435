// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/bench/force_bench.hpp"

namespace tacto::firmware_host {
namespace {

OdeState<5> as_array(const SensorState& s) {
  return {s.tray_m, s.tray_mps, s.charge_lag_n, s.inner_m, s.inner_mps};
}

SensorState as_state(const OdeState<5>& s) {
  return {s[0], s[1], s[2], s[3], s[4]};
}

}  // namespace

ForceBench::ForceBench(const schema::Transducer& transducer, const ForcePlan& force, double sample_rate_hz,
                       const std::optional<SecondMode>& second_mode)
    : sensor_(transducer, second_mode),
      force_(force),
      step_s_(1 / (sample_rate_hz * substeps_in(1 / sample_rate_hz))),
      substeps_(substeps_in(1 / sample_rate_hz)) {}

bool ForceBench::step(const FingerPlace& bone, double load_n) {
  OdeState<5> state = as_array(state_);
  for (int i = 0; i < substeps_; ++i, ++steps_)
    state = runge_kutta_step(state, step_s_, [&](const OdeState<5>& s, double part) {
      const double time_s = (static_cast<double>(steps_) + part) * step_s_;
      return as_array(sensor_.rate(as_state(s), force_.at(time_s)));
    });
  state_ = as_state(state);
  reading_ = {sensor_.output_v(state_), force_.at(static_cast<double>(steps_) * step_s_), load_n,
              bone.position_m};
  return true;
}

}  // namespace tacto::firmware_host
