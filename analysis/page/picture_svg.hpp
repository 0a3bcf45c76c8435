// SPDX-License-Identifier: GPL-3.0-or-later
// The curves of results, drawn.
#pragma once

#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/results/results.hpp"
#include "spatial/picture/line_plot.hpp"

namespace tacto::analysis {

/// As a figure; `simulated` says by what, and shows a badge.
spatial::LineFigure figure_of(const schema::ResultPicture& picture, const std::string& simulated);

/// All of them as <img> with their SVG inside; a picture without a finite point as a line of text. Errors: of
/// drawing.
schema::Result<std::string> pictures_html(std::span<const schema::ResultPicture> pictures,
                                          const std::string& simulated);

/// Figures as a table of two columns.
std::string figures_html(std::span<const schema::ResultFigure> figures);

}  // namespace tacto::analysis
