// SPDX-License-Identifier: GPL-3.0-or-later
// The figures, pictures and page of fitted answers and preferences.
#pragma once

#include <string>
#include <vector>

#include "analysis/experiment/answers_fit.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// The preferences of one group of rows, as a scale.
struct ScaledGroup {
  std::vector<std::string> by;
  PreferenceScale scale;
};

/// What a fit shows to people.
struct Findings {
  std::vector<schema::ResultFigure> figures;     ///< the first is the verdict
  std::vector<schema::ResultPicture> pictures;   ///< one per person, or per group of preferences
  std::vector<std::vector<std::string>> groups;  ///< of fits: a head, then a row per group
  std::string simulated;                         ///< by what, where an answer or a session is simulated

  const std::string& verdict() const { return figures.front().value; }
};

Findings findings_of(const AnswersFit& fit);
Findings findings_of(const std::vector<ScaledGroup>& scales);

/// A page with verdict, figures, pictures and the table of all groups. Errors: those of drawing.
schema::Result<std::string> findings_page(const std::string& file, const Findings& findings);

}  // namespace tacto::analysis
