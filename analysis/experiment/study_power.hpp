// SPDX-License-Identifier: GPL-3.0-or-later
// How many participants a study needs to find a difference between two Weber fractions.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "data-schema/experiment/protocol.hpp"

namespace tacto::analysis {

/// What is assumed: the Weber fractions of both conditions, the spread of people (standard deviation of ln
/// W), and the share of answers by chance.
struct PowerAssumptions {
  std::array<double, 2> weber = {};
  double spread = 0;
  std::optional<double> lapse = {};
  std::uint64_t seed = 1;
};

inline constexpr double kPowerGoal = 0.8;
/// A power of 80 % is known within 1.6 % (standard error; the people that were drawn make most of it).
inline constexpr int kSimulatedPeople = 5000, kSimulatedStudies = 10'000;
inline constexpr int kMostPeople = 200;  ///< in a group

struct StudyPower {
  /// Of the simulated people's fits, in each condition: geometric mean, standard deviation of ln W; and that
  /// of the difference of ln W of one person in both conditions.
  std::array<double, 2> weber = {}, spread = {};
  double spread_of_difference = 0;
  int unfitted = 0;  ///< people without a fit, for example a step between two levels: left out
  struct Row {
    int people = 0;
    double groups = 0;  ///< power with so many people in each of two groups
    double twice = 0;   ///< with so many people in both conditions
  };
  std::vector<Row> rows;              ///< to the first with both at the goal
  std::optional<int> a_group, twice;  ///< fewest people for the goal; none: more than kMostPeople
};

/// Simulates kSimulatedPeople, each with the protocol's levels and repetitions in both conditions, fits each
/// as `analyse` does, and draws from them the people of kSimulatedStudies studies of each size. In each,
/// Student's t test of ln W (5 %, two-sided; two groups, or paired) finds the difference or not. The seed
/// decides all draws. Errors: usage: equal fractions, or values out of range; unsuitable: a protocol without
/// Weber fractions; hardly any of these people can be fitted. `tell` receives 0 to 1.
schema::Result<StudyPower> study_power(const schema::Protocol& protocol, const PowerAssumptions& assumed,
                                       const std::function<void(double)>& tell);

}  // namespace tacto::analysis
