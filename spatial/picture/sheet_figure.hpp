// SPDX-License-Identifier: GPL-3.0-or-later
// A contact sheet: many textures side by side with common scales of position, value, frequency and colour.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/geometry.hpp"
#include "spatial/picture/draw/heading.hpp"
#include "spatial/picture/figure.hpp"
#include "spatial/picture/heatmap.hpp"
#include "spatial/picture/spectrogram_figure.hpp"

namespace tacto::spatial {

/// The common scales of all cells of all pages, so that shades and heights can be compared.
struct SheetScales {
  double length_mm = 1;                   ///< of the longest texture
  double low_value = -1, high_value = 1;  ///< in the textures' unit
  double low_per_mm = 0.1, high_per_mm = 15;
  LevelRange levels;
};

/// Errors: unsuitable, if units differ or there is hardly a frequency to show. Precondition: at least one
/// panel.
schema::Result<SheetScales> sheet_scales(std::span<const SpectrogramPanel> panels,
                                         const SpectrogramPictureOptions& options);

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

/// One page: for each texture value against position above the spectrogram, with name and speed. What the
/// recording could not determine is hatched; simulated textures are labelled.
class SheetFigure : public Figure {
 public:
  /// `columns` 0: automatic. Precondition: 1 to kCellsOfAPage panels.
  SheetFigure(std::vector<SpectrogramPanel> panels, const SheetScales& scales, const std::string& title,
              std::size_t columns = 0);

  Size page() const override { return layout_.page(); }
  schema::Result<void> draw(Canvas& canvas) const override;
  const SheetLayout& layout() const { return layout_; }
  /// Axes of one cell, in mm and 1/mm.
  Axis positions(std::size_t cell) const;
  Axis frequencies(std::size_t cell) const;

 private:
  schema::Result<void> draw_cell(Canvas& canvas, std::size_t index) const;
  void draw_title(Canvas& canvas, std::size_t index) const;
  void draw_trace(Canvas& canvas, std::size_t index) const;
  schema::Result<void> draw_heat(Canvas& canvas, std::size_t index) const;
  void draw_bar(Canvas& canvas) const;

  std::vector<SpectrogramPanel> panels_;
  SheetScales scales_;
  SheetLayout layout_;
  Heading heading_;
};

}  // namespace tacto::spatial
