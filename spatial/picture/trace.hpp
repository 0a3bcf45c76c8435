// SPDX-License-Identifier: GPL-3.0-or-later
// Reduces a curve with any number of samples to the resolution of a page.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

/// Resolution of curves, in columns per point: that of a PNG's pixels.
inline constexpr double kColumnsPerPoint = 2;

/// The curve through (x[i], y[i]) on the page, in pieces that end at values that are not finite. Of all
/// samples in one pixel column the first, smallest, largest and last are kept, so that the curve looks as
/// with all samples. Precondition: x and y of equal size.
std::vector<std::vector<Point>> trace(std::span<const double> x, std::span<const double> y,
                                      const Axis& x_axis, const Axis& y_axis,
                                      double columns_per_point = kColumnsPerPoint);

}  // namespace tacto::spatial
