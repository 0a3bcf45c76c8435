// SPDX-License-Identifier: GPL-3.0-or-later
// The figures, pictures and page of fitted answers and preferences.
#pragma once

#include <string>
#include <vector>

#include "analysis/experiment/answers_fit.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// "8.293 [7.07, 9.073] cm/s"
std::string in_words(const Estimate& estimate, const std::string& unit);

/// The preferences of one group of rows, as a scale.
struct ScaledGroup {
  std::vector<std::string> by;
  PreferenceScale scale;
};

std::string answers_verdict(const AnswersFit& fit);
std::string preferences_verdict(const std::vector<ScaledGroup>& scales);

/// The main figures. The verdict is the first.
std::vector<schema::ResultFigure> answers_figures(const AnswersFit& fit);
std::vector<schema::ResultFigure> preferences_figures(const std::vector<ScaledGroup>& scales);

/// A head and a row per group: columns of --by, threshold, steepness, lapses, p.
std::vector<std::vector<std::string>> groups_table(const AnswersFit& fit);

/// One picture per person, or per group of preferences.
std::vector<schema::ResultPicture> answers_pictures(const AnswersFit& fit);
std::vector<schema::ResultPicture> preferences_pictures(const std::vector<ScaledGroup>& scales);

/// A page with verdict, figures, pictures and the table of all groups. Errors: those of drawing.
schema::Result<std::string> answers_page(const std::string& file, const AnswersFit& fit);
schema::Result<std::string> preferences_page(const std::string& file, const std::vector<ScaledGroup>& scales);

}  // namespace tacto::analysis
