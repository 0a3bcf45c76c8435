// SPDX-License-Identifier: GPL-3.0-or-later
// f(x_i) = S_f(S_x^-1(x_i)) at evenly spaced x_i, with the true inverse of S_x (Wiertlewski 2011): both
// monotone cubics in one pass over the knots.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// Places (first + i) pitch, i = 0 ... count - 1; pitch > 0.
struct EvenPlaces {
  double first = 0, pitch = 1;
  std::size_t count = 0;
  double at(std::size_t i) const { return (first + static_cast<double>(i)) * pitch; }
};

/// Places [begin, end) of a segment, to be solved one by one.
struct IterativePlaces {
  std::size_t begin, end, segment;
};

/// Keeps its buffers between strokes; not shared between threads.
///
/// Segments of S_x whose slopes at the ends are within a factor of 3/2 of their secant are solved by two of
/// Halley's steps from the secant, many places at once: error below 2e-12 of the segment. All others, in
/// particular where dx/dt is near 0, are solved one by one inside a bracket (solve_segment: below 1e-10).
/// Compared with bisection in long double by hermite_resampler_test.
class HermiteResampler {
 public:
  /// S_x interpolates (t, x), both strictly increasing, at least 2 knots; t is in samples. S_f interpolates
  /// values[i] at time i - margin, at least 2 values. out.size() = places.count. Places outside the knots
  /// have the time of the first or last knot. Memory: 8 bytes per knot and value.
  void operator()(std::span<const double> t, std::span<const double> x, std::span<const double> values,
                  std::size_t margin, const EvenPlaces& places, std::span<double> out);

 private:
  std::vector<double> x_slopes_, value_slopes_;
  std::vector<IterativePlaces> hard_;
};

}  // namespace tacto::spatial
