// SPDX-License-Identifier: GPL-3.0-or-later
// A comparison as pictures, and as one HTML page that needs no other files.
#pragma once

#include <string>
#include <vector>

#include "analysis/compare/compare.hpp"
#include "analysis/compare/surfaces.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// The main figures for the reader: the verdict first.
std::vector<schema::ResultFigure> surfaces_figures(const SurfaceComparison& comparison);

/// The mean levels of both sides, and their difference with its simultaneous interval, per band.
std::vector<schema::ResultPicture> surfaces_pictures(const SurfaceComparison& comparison);

/// Errors: those of drawing.
schema::Result<std::string> surfaces_page(const SurfaceComparison& comparison);

/// The names of the two inputs.
struct ComparedNames {
  std::string a, b;
  bool with_target = false;  ///< a session and its target: the error is reported, no verdict
};

/// Both spectra by band, their difference with its scatter and, if they are paired, the coherence and a
/// section of both signals. A curve has at most 2,000 points: spectra are means over neighbouring bins,
/// signals are unchanged.
std::vector<schema::ResultPicture> comparison_pictures(const Comparison& comparison,
                                                       const ComparedNames& names);

/// The main figures for the reader: the verdict, or the error, first.
std::vector<schema::ResultFigure> comparison_figures(const Comparison& comparison,
                                                     const ComparedNames& names);

/// Errors: those of drawing.
schema::Result<std::string> comparison_page(const Comparison& comparison, const ComparedNames& names);

}  // namespace tacto::analysis
