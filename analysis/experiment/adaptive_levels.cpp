// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/adaptive_levels.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/experiment/study.hpp"
#include "analysis/experiment/study_answers.hpp"
#include "analysis/psychometrics/psychometric_function.hpp"
#include "analysis/psychometrics/quest_plus.hpp"
#include "analysis/psychometrics/staircase.hpp"

namespace tacto::analysis {
namespace {

using Levels = std::vector<double>;

// From the nearest to 0 to the farthest.
Levels by_size(Levels levels) {
  std::ranges::sort(levels, {}, [](double level) { return std::abs(level); });
  return levels;
}

std::size_t index_of(const Levels& levels, double level) {
  return static_cast<std::size_t>(std::ranges::find(levels, level) - levels.begin());
}

// Its levels are indices.
Staircase staircase_of(const Levels& levels, const schema::ProtocolKey& key,
                       const std::vector<Attempt>& attempts) {
  StaircaseRule rule;
  rule.lowest = 0, rule.highest = static_cast<double>(levels.size() - 1);
  Staircase staircase(rule, rule.highest);
  for (const Attempt& attempt : attempts) {
    if (!attempt.counts()) continue;
    const bool longer = stimulus_of(key, attempt.trial.code).stretch > 0;
    staircase.take_answer(seemed_longer(attempt) == longer);
  }
  return staircase;
}

double quest_level(const Levels& levels, const schema::ProtocolKey& key,
                   const std::vector<Attempt>& attempts) {
  constexpr std::size_t kEquals = 21, kWidths = 16;
  constexpr double kLapse = 0.02, kLeastWidth = 1.0 / 20;
  const double most = std::max(std::abs(levels.front()), std::abs(levels.back()));
  const double quantile_75 = standard_quantile(Shape::normal, 0.75);
  const auto chance = [&](std::size_t stimulus, std::size_t parameters) {
    const double equal = most * (static_cast<double>(parameters % kEquals) / (kEquals - 1) - 0.5);
    const std::size_t width = parameters / kEquals;
    const double part = static_cast<double>(width) / (kWidths - 1);
    const double jnd = most * std::pow(kLeastWidth, 1 - part);
    return PsychometricFunction{Shape::normal, equal, jnd / quantile_75, kLapse / 2, {}}(levels[stimulus]);
  };
  QuestPlus quest(levels.size(), kEquals * kWidths, chance);
  for (const Attempt& attempt : attempts)
    if (attempt.counts())
      quest.take_answer(index_of(levels, stimulus_of(key, attempt.trial.code).stretch),
                        seemed_longer(attempt));
  return levels[quest.next()];
}

}  // namespace

std::string adaptive_code(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                          const std::vector<Attempt>& attempts) {
  double stretch = 0;
  if (protocol.method == schema::LevelMethod::staircase) {
    const Levels levels = by_size(protocol.levels);
    stretch = levels[static_cast<std::size_t>(staircase_of(levels, key, attempts).level())];
  } else {
    stretch = quest_level(protocol.levels, key, attempts);
  }
  return std::ranges::find(key.stimuli, stretch, &schema::CodedStimulus::stretch)->code;
}

std::vector<double> reversals_of(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                 const std::vector<Attempt>& attempts) {
  const Levels levels = by_size(protocol.levels);
  const Staircase staircase = staircase_of(levels, key, attempts);
  std::vector<double> reversals;
  for (const double index : staircase.reversals())
    reversals.push_back(levels[static_cast<std::size_t>(index)]);
  return reversals;
}

}  // namespace tacto::analysis
