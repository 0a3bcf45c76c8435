// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of the task adjustment: which gain was accepted, in ascending and descending series.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/answers_page.hpp"
#include "analysis/experiment/proof.hpp"
#include "analysis/psychometrics/adjustment.hpp"

namespace tacto::analysis {

struct AdjustedPerson {
  std::string participant;
  std::vector<double> ascending, descending;  ///< ratios to the protocol's gain, in the order of the trials
  std::size_t bounds = 0;                     ///< of them at an end of the range
  AdjustmentMeans means;
};

struct AdjustmentAnswers {
  schema::Goal goal = schema::Goal::least;
  /// RMS of the texture's force on the path in the band that is played at the protocol's pace, times the
  /// protocol's gain: what the ratio 1 stands for.
  double unit_rms_m = 0;
  std::string band;  ///< in words, with the speed
  std::vector<AdjustedPerson> people;
  /// Of one person; or the geometric mean of two or more who have one. The hysteresis of several people is
  /// the mean of theirs.
  std::optional<Estimate> ratio, hysteresis_db;
  std::size_t abandoned = 0;
  std::string simulated;
};

/// Of the trials that were delivered and answered. Precondition: at least one run, all of one adjustment.
/// Errors: those of read_texture.
schema::Result<AdjustmentAnswers> adjustment_answers(const std::vector<Run>& runs);

Findings findings_of(const AdjustmentAnswers& answers);

}  // namespace tacto::analysis
