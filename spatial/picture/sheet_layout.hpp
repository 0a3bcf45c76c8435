// SPDX-License-Identifier: GPL-3.0-or-later
// The places of the cells on a contact sheet.
#pragma once

#include <cstddef>

#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

/// The maximum number of cells on one page.
inline constexpr std::size_t kCellsOfAPage = 24;

/// The place of one texture.
struct SheetCell {
  Box title, trace, heat;
  bool leftmost = false;  ///< has the values of its vertical axes
  bool lowest = false;    ///< has no cell below it, so it has those of the position axis
};

/// A page of `cells` cells in `columns` columns. 0 columns: as many as make the page about as wide as high,
/// at most four.
struct SheetLayout {
  SheetLayout(std::size_t cells, std::size_t columns);
  Size page() const;
  SheetCell cell(std::size_t index) const;
  Box heading() const;
  Box bar() const;  ///< for the colours
  std::size_t cells = 0, columns = 1, rows = 1;
  double heading_height;  ///< kHeadingHeight; more for a title of several lines
};

}  // namespace tacto::spatial
