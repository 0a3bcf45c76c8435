// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/trial_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "data-schema/files/files.hpp"

namespace tacto::analysis {
namespace {

template <class Value, class TextOf>
std::vector<Value> sorted_by_sum(std::vector<Value> values, const TextOf& text_of) {
  std::vector<std::pair<std::string, Value>> sums;
  for (Value& value : values) sums.emplace_back(schema::sha256_of(text_of(value)), std::move(value));
  std::ranges::sort(sums, {}, &std::pair<std::string, Value>::first);
  values.clear();
  for (auto& [sum, value] : sums) values.push_back(std::move(value));
  return values;
}

}  // namespace

std::vector<StudyTrial> ordered_trials(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                       const std::string& participant) {
  std::vector<StudyTrial> trials;
  for (const schema::CodedStimulus& stimulus : key.stimuli)
    for (int i = 1; i <= protocol.repetitions && stimulus.stretch != 0; ++i)
      trials.push_back({stimulus.code, i});
  return sorted_by_sum(std::move(trials), [&](const StudyTrial& trial) {
    return fmt::format("{}/{}/1/{}", protocol.seed, participant, trial.name());
  });
}

std::vector<double> stretches_by_code(const schema::Protocol& protocol) {
  std::vector<double> stretches = protocol.levels;
  stretches.push_back(0);
  return sorted_by_sum(std::move(stretches),
                       [&](double stretch) { return fmt::format("{}/code/{:g}", protocol.seed, stretch); });
}

}  // namespace tacto::analysis
