// SPDX-License-Identifier: GPL-3.0-or-later
// A curve with any number of samples as one that a page can hold.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

/// Pixels of a page: how finely curves are kept, columns a point.
inline constexpr double kColumnsPerPoint = 2;

/// The curve through (x[i], y[i]) on the page, in pieces that end where a value is not finite. Of all samples
/// that fall in one pixel column the first, smallest, largest and last are kept, so that it looks as if all
/// were drawn. Precondition: x and y of equal size.
std::vector<std::vector<Point>> trace(std::span<const double> x, std::span<const double> y,
                                      const Axis& x_axis, const Axis& y_axis,
                                      double columns_per_point = kColumnsPerPoint);

}  // namespace tacto::spatial
