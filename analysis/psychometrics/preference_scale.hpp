// SPDX-License-Identifier: GPL-3.0-or-later
// A scale from paired comparisons: Bradley and Terry 1952 (Biometrika 39).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/psychometrics/psychometric_fit.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// `winner` was preferred over `loser` so many times.
struct Preference {
  std::string winner, loser;
  double count = 1;
};

/// An item's ability: the logarithm of its odds against the reference.
struct ScaledItem {
  std::string name;
  Estimate ability;  ///< with Wald's 95 % interval of the difference to the reference
};

struct PreferenceScale {
  std::vector<ScaledItem> items;  ///< from the most preferred to the least, which is the reference (0)
  double comparisons = 0;
  double deviance = 0;  ///< against the proportions of each pair themselves
  std::size_t freedom = 0;
  double p = 1;  ///< of a deviance this large, if one scale explains all pairs (chi-squared)
};

/// P(i over j) = 1 / (1 + exp(ability_j - ability_i)), by maximum likelihood. Errors: unsuitable: fewer than
/// two items, an item compared with itself, a group of items over which no other item was ever preferred (the
/// scale has no bound). Pure.
schema::Result<PreferenceScale> fit_preferences(std::span<const Preference> preferences);

}  // namespace tacto::analysis
