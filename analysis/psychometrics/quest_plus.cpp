// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/quest_plus.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tacto::analysis {

QuestPlus::QuestPlus(std::size_t stimuli, std::size_t parameters,
                     const std::function<double(std::size_t, std::size_t)>& chance)
    : posterior_(parameters, 1 / static_cast<double>(parameters)) {
  for (std::size_t s = 0; s < stimuli; ++s) {
    auto& row = chances_.emplace_back();
    for (std::size_t p = 0; p < parameters; ++p) row.push_back(chance(s, p));
  }
}

// The sum over both answers of -q log(q / P): q is the joint probability of answer and parameters, P its sum.
double QuestPlus::expected_entropy(std::size_t stimulus) const {
  double yes = 0, no = 0, sum = 0;
  const auto add = [&sum](double joint, double& total) {
    total += joint;
    if (joint > 0) sum -= joint * std::log(joint);
  };
  for (std::size_t p = 0; p < posterior_.size(); ++p) {
    const double chance = chances_[stimulus][p];
    add(posterior_[p] * chance, yes);
    add(posterior_[p] * (1 - chance), no);
  }
  for (const double total : {yes, no})
    if (total > 0) sum += total * std::log(total);
  return sum;
}

std::size_t QuestPlus::next() const {
  std::vector<double> entropies;
  for (std::size_t s = 0; s < chances_.size(); ++s) entropies.push_back(expected_entropy(s));
  constexpr double kRounding = 2e-15;  // of entropies below 16
  const double enough = *std::ranges::min_element(entropies) + kRounding;
  return static_cast<std::size_t>(
      std::ranges::find_if(entropies, [&](double each) { return each <= enough; }) - entropies.begin());
}

void QuestPlus::take_answer(std::size_t stimulus, bool yes) {
  for (std::size_t p = 0; p < posterior_.size(); ++p)
    posterior_[p] *= yes ? chances_[stimulus][p] : 1 - chances_[stimulus][p];
  const double sum = std::accumulate(posterior_.begin(), posterior_.end(), 0.0);
  for (double& each : posterior_) each /= sum;
}

std::size_t QuestPlus::mode() const {
  return static_cast<std::size_t>(std::ranges::max_element(posterior_) - posterior_.begin());
}

}  // namespace tacto::analysis
