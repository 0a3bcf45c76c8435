// SPDX-License-Identifier: GPL-3.0-or-later
// A comparison as pictures, and as one page that needs nothing beside it.
#pragma once

#include <string>
#include <vector>

#include "analysis/compare/compare.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// How the two are called.
struct ComparedNames {
  std::string a, b;
};

/// Both spectra by band, their difference with its scatter, and where they are paired the coherence and a
/// stretch of both signals (2,000 points at most a curve: spectra as means over neighbouring bins, signals as
/// they are).
std::vector<schema::ResultPicture> comparison_pictures(const Comparison& comparison,
                                                       const ComparedNames& names);

/// The main figures, as people read them: the verdict first.
std::vector<schema::ResultFigure> comparison_figures(const Comparison& comparison);

/// Errors: of drawing.
schema::Result<std::string> comparison_page(const Comparison& comparison, const ComparedNames& names);

}  // namespace tacto::analysis
