// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/bench/bench.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::firmware_host {

int substeps_in(double period_s) {
  return std::max(1, static_cast<int>(std::ceil(period_s / kLongestStepS - 1e-9)));
}

}  // namespace tacto::firmware_host
