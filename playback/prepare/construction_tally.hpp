// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the levels, filters and other parts that were built for a playback.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tacto::playback {

/// The counters of what a scene does not name stay at 0.
struct ConstructionTally {
  std::size_t texture_files = 0;    ///< read
  std::size_t textures_placed = 0;  ///< on the encoder's axis
  std::size_t seams = 0;            ///< of loops, faded
  std::size_t levels = 0;           ///< transformed
  std::size_t sample_bytes = 0;     ///< of all levels
  std::size_t filters = 0;          ///< by least squares; a gain alone is none
  std::size_t taps = 0;             ///< including the single one of a gain
  std::size_t hysteresis = 0;       ///< operators inverted
  std::size_t play_operators = 0;   ///< of the inverted hysteresis
  std::size_t sections = 0;         ///< recursive
  std::size_t energy_limits = 0;
  std::size_t touch_gates = 0;
  std::size_t following = 0;  ///< look-aheads and timings of edges
};

struct Prepared;

/// A part that was not built, and why.
struct LeftOut {
  std::string part, because;
};
std::vector<LeftOut> left_out_of(const Prepared& prepared);

}  // namespace tacto::playback
