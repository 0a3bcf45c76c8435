// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/load_cell.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::firmware_host {
namespace {

constexpr int kLoadCellBits = 16;
constexpr double kNoiseN = 1.0 / 320;   // ATI Nano17, SI-12-0.12: resolution
constexpr double kNativeRateHz = 1000;  // ours
constexpr double kCutoffHz = 200;       // ours: well below half of the native rate

}  // namespace

LoadCell::LoadCell(double range_n, double sample_rate_hz, bool noise, Random random)
    : converter_(kLoadCellBits, range_n),
      random_(random),
      every_(std::max(1, static_cast<int>(std::lround(sample_rate_hz / kNativeRateHz)))),
      native_rate_hz_(sample_rate_hz / every_),
      follow_(1 / (1 + sample_rate_hz / (2 * std::numbers::pi * kCutoffHz))),
      noise_n_(noise ? kNoiseN : 0) {}

std::int32_t LoadCell::step(double force_n) {
  filtered_n_ += follow_ * (force_n - filtered_n_);
  if (until_next_-- > 0) return held_;
  until_next_ = every_ - 1;
  held_ = converter_.convert(filtered_n_ + noise_n_ * random_.normal());
  return held_;
}

}  // namespace tacto::firmware_host
