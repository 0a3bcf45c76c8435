// SPDX-License-Identifier: GPL-3.0-or-later
// The layout of a page of spectrograms, and the common axes of its panels.
#pragma once

#include <cstddef>
#include <span>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

/// The part of the page for one texture.
struct PanelLayout {
  Box heading, trace, heat, mean, bar, notes;
};

/// The page for panels with headings of these heights, and the place of one of them. A single panel is higher
/// than one of several; a heading above kHeadingHeight makes its panel higher.
Size page_of(std::span<const double> heading_heights);
PanelLayout panel_layout(std::size_t panel, std::span<const double> heading_heights);
double heading_width();

/// In the units of the page's axes: millimetres and 1/mm.
Axis position_axis(double low_mm, double high_mm, const Box& box);
Axis frequency_axis(double low_per_mm, double high_per_mm, const Box& box);

/// The part of `heat` that the spectrogram covers, on whole pixels of a PNG: half a window is missing at each
/// end of a texture.
Box covered(const Box& heat, const Axis& position_mm, const schema::Spectrogram& spectrogram);

}  // namespace tacto::spatial
