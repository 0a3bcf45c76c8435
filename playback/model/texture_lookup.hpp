// SPDX-License-Identifier: GPL-3.0-or-later
// The value of the texture at any position of the bench.
#pragma once

#include <cstddef>

#include "data-schema/base/signal.hpp"

namespace tacto::playback {

/// How long the ends of a texture fade: 1 mm, or a tenth of one that is shorter than 10 mm.
double fade_of(double length_m);

/// A texture placed with its first sample at `at_m`, and interpolated by cubic Hermite polynomials whose
/// slopes are central differences of fourth order. Error for a sinusoid of spatial frequency k: at most
/// 0.0026 w^4 + 0.0032 w^5 of its amplitude, w = 2 pi k pitch: -132 dB at 15 /mm on a 1 um grid, -88 dB at 50
/// /mm.
///
/// Ends: stop. Outside, the value is zero; inside, the last fade_m() before each end fade by a raised cosine,
/// so that there is no step at the ends.
class TextureLookup {
 public:
  /// At least 2 samples. Keeps a reference: the signal must outlive it.
  TextureLookup(const schema::SpaceSignal& signal, double at_m);

  /// Value at a bench position, in the unit of the texture.
  double operator()(double position_m) const;
  bool contains(double position_m) const;
  double fade_m() const { return fade_m_; }

 private:
  double interpolated(double grid_position) const;
  double slope(std::size_t i) const;
  double fade(double distance_to_end_m) const;

  const schema::SpaceSignal& signal_;
  double at_m_;
  double fade_m_;
};

}  // namespace tacto::playback
