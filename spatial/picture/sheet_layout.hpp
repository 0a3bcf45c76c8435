// SPDX-License-Identifier: GPL-3.0-or-later
// Where the cells of a contact sheet stand.
#pragma once

#include <cstddef>

#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

/// The most cells on one page.
inline constexpr std::size_t kCellsOfAPage = 24;

/// One texture's place.
struct SheetCell {
  Box title, trace, heat;
  bool leftmost = false;  ///< carries the values of its vertical axes
  bool lowest = false;    ///< has no cell under it, so it carries those of the position axis
};

/// A page of `cells` cells in so many columns: as many as make it about as wide as high, at most four, where
/// none are asked for (0).
struct SheetLayout {
  SheetLayout(std::size_t cells, std::size_t columns);
  Size page() const;
  SheetCell cell(std::size_t index) const;
  Box heading() const;
  Box bar() const;  ///< of colours
  std::size_t cells = 0, columns = 1, rows = 1;
  double heading_height;  ///< kHeadingHeight; more for a title of several lines
};

}  // namespace tacto::spatial
