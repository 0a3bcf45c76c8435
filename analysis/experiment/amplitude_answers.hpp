// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of the task amplitude: at which ratio to the real sample a texture seems equal to it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/answers_page.hpp"
#include "analysis/experiment/proof.hpp"
#include "analysis/psychometrics/rating_match.hpp"

namespace tacto::analysis {

/// What one participant answered. The ratios are those that were asked: 'prove' says how well they were
/// played.
struct MatchedPerson {
  std::string participant;
  std::vector<RatedRatio> ratings;  ///< as answered
  std::size_t rated_0 = 0;
  std::optional<double> mean_at_0;  ///< mean ratio of the trials that were rated 0; none: there is none
  std::optional<Estimate> match;    ///< none: see why
  std::string why;
};

struct AmplitudeAnswers {
  std::vector<MatchedPerson> people;
  std::optional<double> mean_at_0;  ///< mean over those people who have one
  std::optional<Estimate> match;    ///< of one person; or the geometric mean of two or more who have one
  std::string simulated;
};

/// Of the trials that were delivered and answered. Precondition: at least one run, all of one study of
/// amplitude.
AmplitudeAnswers amplitude_answers(const std::vector<Run>& runs);

Findings findings_of(const AmplitudeAnswers& answers);

}  // namespace tacto::analysis
