// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/sheet_layout.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/picture/draw/heading.hpp"

namespace tacto::spatial {
namespace {

constexpr double kSheetMargin = 14;
constexpr double kLeft = 58, kRight = 82, kBottom = 46;  // space for axes and the bar
constexpr double kSheetTitle = 30, kTraceHeight = 46, kGap = 5, kHeat = 120;
constexpr double kBetweenColumns = 14, kBetweenRows = 12;
constexpr double kRow = kSheetTitle + kTraceHeight + kGap + kHeat;

// A single column is wide; four columns fit on a page.
double cell_width(std::size_t columns) {
  return columns == 1 ? 440 : columns == 2 ? 300 : 226;
}

std::size_t usual_columns(std::size_t cells) {
  return std::clamp<std::size_t>(
      static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(cells) * 0.8))), 1, 4);
}

}  // namespace

SheetLayout::SheetLayout(std::size_t cell_count, std::size_t target_columns)
    : cells(cell_count),
      columns(std::min(target_columns == 0 ? usual_columns(cell_count) : target_columns, cell_count)),
      heading_height(kHeadingHeight) {
  rows = (cells + columns - 1) / columns;
}

Size SheetLayout::page() const {
  const auto across = static_cast<double>(columns), down = static_cast<double>(rows);
  return {kLeft + across * cell_width(columns) + (across - 1) * kBetweenColumns + kRight,
          kSheetMargin + heading_height + down * kRow + (down - 1) * kBetweenRows + kBottom};
}

Box SheetLayout::heading() const {
  return {kSheetMargin, kSheetMargin, page().width - 2 * kSheetMargin, heading_height};
}

SheetCell SheetLayout::cell(std::size_t index) const {
  const std::size_t rows_above = index / columns;
  const auto column = static_cast<double>(index % columns), row = static_cast<double>(rows_above);
  const double width = cell_width(columns);
  const double x = kLeft + column * (width + kBetweenColumns);
  const double y = kSheetMargin + heading_height + row * (kRow + kBetweenRows);
  SheetCell cell;
  cell.title = {x, y, width, kSheetTitle};
  cell.trace = {x, y + kSheetTitle, width, kTraceHeight};
  cell.heat = {x, y + kSheetTitle + kTraceHeight + kGap, width, kHeat};
  cell.leftmost = index % columns == 0;
  cell.lowest = index + columns >= cells;
  return cell;
}

Box SheetLayout::bar() const {
  const double top = cell(0).trace.y;
  const double height =
      std::min(rows == 1 ? kTraceHeight + kGap + kHeat : 220.0, page().height - top - kBottom);
  return {page().width - kRight + 14, top, 12, height};
}

}  // namespace tacto::spatial
