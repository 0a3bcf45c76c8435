// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/formant_match.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::analysis {
namespace {

bool share_places(const schema::Formant& a, const schema::Formant& b) {
  const double common = std::min(a.to_m, b.to_m) - std::max(a.from_m, b.from_m);
  return common >= std::min(a.to_m - a.from_m, b.to_m - b.from_m) / 2;
}

}  // namespace

FormantMatch match_formants(std::span<const schema::Formant> a, std::span<const schema::Formant> b,
                            double resolution_per_m, bool by_place) {
  FormantMatch match;
  std::vector<bool> taken(b.size(), false);
  for (std::size_t i = 0; i < a.size(); ++i) {
    double nearest = resolution_per_m / 2;
    std::size_t found = b.size();
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double apart = std::abs(b[j].frequency_per_m - a[i].frequency_per_m);
      if (taken[j] || apart > nearest || (by_place && !share_places(a[i], b[j]))) continue;
      nearest = apart;
      found = j;
    }
    if (found == b.size()) {
      match.missed.push_back(i);
      continue;
    }
    taken[found] = true;
    match.matched.emplace_back(i, found);
  }
  for (std::size_t j = 0; j < b.size(); ++j)
    if (!taken[j]) match.extra.push_back(j);
  return match;
}

}  // namespace tacto::analysis
