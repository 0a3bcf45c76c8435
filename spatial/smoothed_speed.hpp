// SPDX-License-Identifier: GPL-3.0-or-later
// The finger's speed from positions that are quantised: differences over a window, not from sample to sample.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// Speed at each sample, in m/s with its sign: the difference over `window` samples around it (>= 2; rounded
/// down to even), over what there is of them at the ends. Error from a quantum q: q / (window /
/// sample_rate_hz) at most. At least 2 positions, in m.
std::vector<double> smoothed_speed(std::span<const double> position_m, double sample_rate_hz,
                                   std::size_t window);

/// The window that brings a quantum's error under 10 % of `speed_mps`: 20 ms, or 10 quanta at that speed
/// where that is longer, 0.5 s at most. In samples, at least 2.
std::size_t speed_window(double quantum_m, double speed_mps, double sample_rate_hz);

/// The speed at which half of the whole way was gone: pauses, however long, weigh nothing. 0 where nothing
/// moves.
double travelling_speed(std::span<const double> speed_mps);

/// The step of the positions' grid: the smallest change from one step to the next. 0 where nearly all steps
/// are equal, as of a nominal position, and no grid shows. m.
double position_quantum(std::span<const double> position_m);

}  // namespace tacto::spatial
