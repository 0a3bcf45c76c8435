// SPDX-License-Identifier: GPL-3.0-or-later
// The finger's speed from quantised or noisy positions: differences over a window instead of from sample to
// sample.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "spatial/strokes/frame_range.hpp"

namespace tacto::spatial {

/// Speed at each sample, in m/s with its sign: the difference over `window` samples around it (>= 2; rounded
/// down to even), over fewer at the ends. Largest error from a quantum q: q / (window / sample_rate_hz).
/// Precondition: at least 2 positions, in m.
std::vector<double> smoothed_speed(std::span<const double> position_m, double sample_rate_hz,
                                   std::size_t window);

/// The window for which an error of `resolution_m` is below 10 % of `speed_mps`: 20 ms, or the time of 10
/// resolutions at that speed if that is longer, at most 0.5 s. In samples, at least 2.
std::size_t speed_window(double resolution_m, double speed_mps, double sample_rate_hz);

/// Calls visit(frame, speed_mps, position_m) for the frames `within` a section without gaps, in order; the
/// speeds are those of smoothed_speed() over the whole section. Memory: a chunk and a window. Errors: of
/// reading.
template <class Visit>
schema::Result<void> visit_speeds(const ReadFrames& read, FrameRange section, FrameRange within,
                                  double sample_rate_hz, std::size_t window, const Visit& visit) {
  std::vector<double> positions;
  const std::size_t half = window / 2;
  return chunk_by_chunk(within, [&](FrameRange part) -> schema::Result<void> {
    const FrameRange seen{std::max(part.begin, section.begin + half) - half,
                          std::min(part.end + half, section.end)};
    if (seen.size() < 2) return {};
    positions.resize(seen.size());
    if (auto done = read(seen.begin, positions); !done) return done;
    const auto speeds = smoothed_speed(positions, sample_rate_hz, window);
    for (std::size_t i = part.begin; i < part.end; ++i)
      visit(i, speeds[i - seen.begin], positions[i - seen.begin]);
    return {};
  });
}

}  // namespace tacto::spatial
