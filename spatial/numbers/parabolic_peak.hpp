// SPDX-License-Identifier: GPL-3.0-or-later
// The position of a peak between samples.
#pragma once

namespace tacto::spatial {

struct ParabolicPeak {
  double offset = 0;  ///< from the middle sample, -0.5 to 0.5 for a maximum
  double value = 0;
};

/// Vertex of the parabola through three values at -1, 0 and 1, of which the middle one is the largest. For
/// levels in the main lobe of a Blackman window with zero padding to twice its length, the error of the
/// offset is 0.002 bins.
inline ParabolicPeak parabolic_peak(double before, double middle, double after) {
  const double curve = before - 2 * middle + after;
  if (!(curve < 0)) return {0, middle};
  const double offset = 0.5 * (before - after) / curve;
  return {offset, middle - 0.25 * (before - after) * offset};
}

}  // namespace tacto::spatial
