// SPDX-License-Identifier: GPL-3.0-or-later
// Axes: the mapping from a value to its place on the page, and the round values of the ticks.
#pragma once

#include <string>
#include <vector>

namespace tacto::spatial {

enum class AxisScale { linear, logarithmic };

/// Maps [low, high] onto [at_low, at_high] on the page; at_low may be the larger (y grows downwards).
/// Preconditions: low < high, and 0 < low where logarithmic.
struct Axis {
  AxisScale scale = AxisScale::linear;
  double low = 0, high = 1;
  double at_low = 0, at_high = 1;

  double place(double value) const;
  double value(double place) const;
};

struct Tick {
  double value = 0;
  std::string label;  ///< empty for a minor tick
};

/// Ticks at 1, 2 or 5 times a power of ten, about `target` of them, labelled with as many decimals as they
/// need. On a logarithmic axis there is a tick at each multiple of a power of ten; the powers of ten are
/// labelled and, if there are few of them, also 2 and 5 times these.
std::vector<Tick> ticks_of(const Axis& axis, int target);

/// An axis a little longer than the data, so that no curve touches its frame. If all values are equal, it has
/// a margin on both sides.
Axis roomy_axis(double low, double high);

}  // namespace tacto::spatial
