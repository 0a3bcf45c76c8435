// SPDX-License-Identifier: GPL-3.0-or-later
// The shift of a texture for the best agreement with another one of the same place.
#pragma once

#include <span>

namespace tacto::spatial {

/// Values on the multiples of a pitch on the bench; the first is at `first` pitches.
struct BenchValues {
  double first = 0;
  std::span<const double> values;
};

struct Alignment {
  double shift = 0;        ///< pitches to add to the positions of the second
  double correlation = 0;  ///< of the two after the shift, -1 ... 1
  bool found = false;  ///< false if the best shift is at an end of the range or its correlation is below 0.3
};

/// The shift within +- `range` pitches for which sum(a b) / sqrt(sum(a^2) sum(b^2)) over the overlap (at
/// least half of the shorter one) is largest: by FFT at whole pitches, then the vertex of a parabola through
/// three of them. Error of the parabola for content below a twentieth of the grid's highest frequency: 0.01
/// pitches; noise adds its own. Needs memory for the transforms of both.
Alignment align(const BenchValues& a, const BenchValues& b, double range);

}  // namespace tacto::spatial
