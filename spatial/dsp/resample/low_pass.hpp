// SPDX-License-Identifier: GPL-3.0-or-later
// Low-pass filters of linear phase for decimation.
#pragma once

#include <cstddef>
#include <vector>

namespace tacto::spatial {

/// A symmetric filter of odd length whose response is 1 from 0 to `pass` and 0 from `stop` on, both to within
/// 2.5e-7 (-132 dB), with Kaiser's window (Kaiser 1974; Oppenheim and Schafer, Discrete-Time Signal
/// Processing, 7.5.3). Edges in cycles per sample, 0 < pass < stop; its values sum to 1.
std::vector<double> low_pass(double pass, double stop);

/// Taps on each side of the middle of such a filter; its length is twice that and one.
std::size_t low_pass_reach(double pass, double stop);

}  // namespace tacto::spatial
