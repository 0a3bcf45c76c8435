// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the curves of results.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"
#include "data-schema/results/results.hpp"
#include "spatial/picture/line_plot.hpp"

namespace tacto::analysis {

/// A picture as a figure. `simulated` is the origin of the simulation and adds a badge.
spatial::LineFigure figure_of(const schema::ResultPicture& picture, const std::string& simulated);

/// All pictures as <img> with their SVG inside; a picture without a finite point becomes a line of text.
/// Errors: those of drawing.
schema::Result<std::string> pictures_html(std::span<const schema::ResultPicture> pictures,
                                          const std::string& simulated);

/// Figures (numbers) as a table of two columns, without those that the page states above it.
std::string figures_html(std::span<const schema::ResultFigure> figures,
                         std::initializer_list<std::string_view> stated_above = {});

}  // namespace tacto::analysis
