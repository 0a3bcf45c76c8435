// SPDX-License-Identifier: GPL-3.0-or-later
// Up-down staircases: Levitt 1971 (J. Acoust. Soc. Am. 49), weighted: Kaernbach 1991 (Percept. Psychophys.
// 49).
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace tacto::analysis {

/// After `correct_to_fall` correct answers in a row the level falls by `down`, after `wrong_to_rise` wrong
/// ones it rises by `up`; each change begins a new count. With one wrong answer to rise and equal steps it
/// settles where p^correct_to_fall = 1/2 (0.7071 for 2, 0.7937 for 3); with 1 and 1 where p down = (1 - p)
/// up.
struct StaircaseRule {
  std::size_t correct_to_fall = 2, wrong_to_rise = 1;
  double up = 1, down = 1;
  double lowest = -INFINITY, highest = INFINITY;  ///< the level stays between them
};

/// Gives the level of each trial and finds its reversals. Pure.
class Staircase {
 public:
  Staircase(const StaircaseRule& rule, double first_level) : rule_(rule), level_(first_level) {}

  double level() const { return level_; }  ///< of the next trial
  /// The answer at level().
  void take_answer(bool correct);
  /// The levels at which the direction changed.
  const std::vector<double>& reversals() const { return reversals_; }

 private:
  StaircaseRule rule_;
  double level_;
  std::size_t correct_ = 0, wrong_ = 0;  // in a row, since the last change
  int direction_ = 0;                    // of the last change: 1 up, -1 down
  std::vector<double> reversals_;
};

}  // namespace tacto::analysis
