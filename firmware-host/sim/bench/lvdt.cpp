// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/bench/lvdt.hpp"

#include <numbers>

#include "firmware-host/sim/bench/bench.hpp"
#include "firmware-host/sim/physics/runge_kutta.hpp"

namespace tacto::firmware_host {
namespace {

constexpr int kLvdtBits = 16;

}  // namespace

Lvdt::Lvdt(const LvdtParameters& parameters, double centre_m, double start_m, double sample_rate_hz,
           bool noise, Random random)
    : converter_(kLvdtBits, parameters.range_m / 2),
      random_(random),
      centre_m_(centre_m),
      noise_m_(noise ? parameters.noise_m : 0),
      time_constant_s_(1 / (2 * std::numbers::pi * parameters.bandwidth_hz)),
      step_s_(1 / (sample_rate_hz * substeps_in(1 / sample_rate_hz))),
      substeps_(substeps_in(1 / sample_rate_hz)),
      before_m_(start_m),
      filtered_m_(start_m) {}

std::int32_t Lvdt::step(double position_m) {
  const double moved_m = (position_m - before_m_) / substeps_;
  OdeState<1> y{filtered_m_};
  for (int i = 0; i < substeps_; ++i)
    y = runge_kutta_step(y, step_s_, [&](const OdeState<1>& s, double part) {
      return OdeState<1>{(before_m_ + moved_m * (i + part) - s[0]) / time_constant_s_};
    });
  filtered_m_ = y[0];
  before_m_ = position_m;
  return converter_.convert(filtered_m_ - centre_m_ + noise_m_ * random_.normal());
}

}  // namespace tacto::firmware_host
