// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/bender_hysteresis.hpp"

#include <algorithm>

namespace tacto::firmware_host {
namespace {

double followed(double play, double u, double threshold) {
  return std::max(u - threshold, std::min(u + threshold, play));
}

}  // namespace

// On the loop between +-A, play i ends at +-(A - r_i), and its opening at u = 0 is 2 min(r_i, A - r_i).
BenderHysteresis::BenderHysteresis(double opening, double amplitude)
    : on_(opening > 0), spacing_(amplitude / kPlays) {
  double ends = 0, apart = 0;
  for (std::size_t i = 0; i < kPlays; ++i) {
    ends += amplitude - threshold(i);
    apart += std::min(threshold(i), amplitude - threshold(i));
  }
  weight_ = opening * amplitude / apart;
  straight_ = 1 - weight_ * ends / amplitude;
}

double BenderHysteresis::at(double u) const {
  if (!on_) return u;
  double sum = 0;
  for (std::size_t i = 0; i < kPlays; ++i) sum += followed(plays_[i], u, threshold(i));
  return straight_ * u + weight_ * sum;
}

void BenderHysteresis::settle(double u) {
  if (!on_) return;
  for (std::size_t i = 0; i < kPlays; ++i) plays_[i] = followed(plays_[i], u, threshold(i));
}

}  // namespace tacto::firmware_host
