// SPDX-License-Identifier: GPL-3.0-or-later
// How far a texture has to be shifted to agree best with another of the same place.
#pragma once

#include <span>

namespace tacto::spatial {

/// Values on the multiples of a pitch on the bench, the first of them at `first` pitches.
struct BenchValues {
  double first = 0;
  std::span<const double> values;
};

struct Alignment {
  double shift = 0;        ///< pitches to add to the positions of the second
  double correlation = 0;  ///< of the two, so shifted, -1 ... 1
  bool found = false;      ///< false where the best lies at the range's end or below a correlation of 0.3
};

/// The shift within +- `range` pitches at which sum(a b) / sqrt(sum(a^2) sum(b^2)) over what overlaps (a half
/// of the shorter at least) is largest: by FFT at whole pitches, then the top of a parabola through three of
/// them. Error of the parabola for content below a twentieth of the grid's highest frequency: 0.01 pitches;
/// noise adds its own. Takes memory for the transforms of both.
Alignment align(const BenchValues& a, const BenchValues& b, double range);

}  // namespace tacto::spatial
