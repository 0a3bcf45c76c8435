// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/angles.hpp"

#include <cmath>

namespace tacto::analysis {

std::vector<double> carried_phase_deg(const std::vector<std::complex<double>>& curve) {
  std::vector<double> phase;
  double turns = 0;
  for (const auto& value : curve) {
    const double plain = std::arg(value) * kDegrees;
    if (!phase.empty()) turns = 360 * std::round((phase.back() - plain) / 360);
    phase.push_back(plain + turns);
  }
  return phase;
}

}  // namespace tacto::analysis
