// SPDX-License-Identifier: GPL-3.0-or-later
// A comparison of surfaces as figures, pictures, and one HTML page that needs no other files.
#pragma once

#include <string>
#include <vector>

#include "analysis/compare/surfaces.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// The main figures for the reader: the verdict first.
std::vector<schema::ResultFigure> surfaces_figures(const SurfaceComparison& comparison);

/// The mean levels of both sides, and their difference with its simultaneous interval, per band.
std::vector<schema::ResultPicture> surfaces_pictures(const SurfaceComparison& comparison);

/// Errors: those of drawing.
schema::Result<std::string> surfaces_page(const SurfaceComparison& comparison);

}  // namespace tacto::analysis
