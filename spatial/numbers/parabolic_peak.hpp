// SPDX-License-Identifier: GPL-3.0-or-later
// Where between its samples a peak lies.
#pragma once

namespace tacto::spatial {

struct ParabolicPeak {
  double offset = 0;  ///< from the middle sample, -0.5 to 0.5 for a maximum
  double value = 0;
};

/// Top of the parabola through three values at -1, 0 and 1, of which the middle one is the largest. For
/// levels of a Blackman window's main lobe, two bins padded to each of its own, the offset is right to 0.002
/// of a bin.
inline ParabolicPeak parabolic_peak(double before, double middle, double after) {
  const double curve = before - 2 * middle + after;
  if (!(curve < 0)) return {0, middle};
  const double offset = 0.5 * (before - after) / curve;
  return {offset, middle - 0.25 * (before - after) * offset};
}

}  // namespace tacto::spatial
