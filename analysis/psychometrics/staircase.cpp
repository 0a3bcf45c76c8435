// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/staircase.hpp"

#include <algorithm>

namespace tacto::analysis {

void Staircase::take_answer(bool correct) {
  (correct ? correct_ : wrong_) += 1;
  (correct ? wrong_ : correct_) = 0;
  const bool falls = correct_ == rule_.correct_to_fall, rises = wrong_ == rule_.wrong_to_rise;
  if (!falls && !rises) return;
  const int direction = rises ? 1 : -1;
  if (direction == -direction_) reversals_.push_back(level_);
  direction_ = direction;
  level_ = std::clamp(level_ + (rises ? rule_.up : -rule_.down), rule_.lowest, rule_.highest);
  correct_ = wrong_ = 0;
}

}  // namespace tacto::analysis
