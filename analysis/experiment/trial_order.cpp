// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/trial_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "data-schema/files/files.hpp"

namespace tacto::analysis {
namespace {

constexpr double kPartOfStarts = 0.25;  // of the range, at each of its ends

template <class Value, class TextOf>
std::vector<Value> sorted_by_sum(std::vector<Value> values, const TextOf& text_of) {
  std::vector<std::pair<std::string, Value>> sums;
  for (Value& value : values) sums.emplace_back(schema::sha256_of(text_of(value)), std::move(value));
  std::ranges::sort(sums, {}, &std::pair<std::string, Value>::first);
  values.clear();
  for (auto& [sum, value] : sums) values.push_back(std::move(value));
  return values;
}

bool is_presented(const schema::Protocol& protocol, const schema::CodedStimulus& stimulus) {
  if (protocol.task == schema::Task::two_interval) return stimulus.stretch != 0;
  if (protocol.task == schema::Task::adjustment) return stimulus.name == protocol.standards.front();
  return protocol.task == schema::Task::amplitude ||
         std::ranges::find(protocol.comparisons, stimulus.name) != protocol.comparisons.end();
}

std::string hashed_text(const schema::Protocol& protocol, const std::string& participant,
                        const StudyTrial& trial) {
  return fmt::format("{}/{}/{}/{}", protocol.seed, participant, trial.block, trial.name());
}

double start_ratio(const schema::Protocol& protocol, const StudyTrial& trial, const std::string& text) {
  const double part = kPartOfStarts * uniform_by_sum(text + "/start");
  const double shift = std::pow(protocol.largest_ratio / protocol.smallest_ratio, part);
  return trial.is_ascending() ? protocol.smallest_ratio * shift : protocol.largest_ratio / shift;
}

std::vector<StudyTrial> orderings(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                  const std::string& participant) {
  std::vector<StudyTrial> trials;
  std::vector<std::string> codes;
  for (const schema::CodedStimulus& stimulus : key.stimuli) codes.push_back(stimulus.code);
  for (int i = 1; i <= protocol.repetitions; ++i) {
    StudyTrial& trial = trials.emplace_back(StudyTrial{"all", i, 1, false, 1});
    const std::string text = hashed_text(protocol, participant, trial);
    trial.arranged =
        sorted_by_sum(codes, [&](const std::string& code) { return fmt::format("{}/{}", text, code); });
  }
  return sorted_by_sum(std::move(trials),
                       [&](const StudyTrial& trial) { return hashed_text(protocol, participant, trial); });
}

std::vector<StudyTrial> adaptive_trials(const schema::Protocol& protocol, const std::string& participant) {
  std::vector<StudyTrial> trials;
  for (int i = 1; i <= protocol.repetitions; ++i) trials.push_back(StudyTrial{"level", i, 1, false, 1, true});
  return sorted_by_sum(std::move(trials),
                       [&](const StudyTrial& trial) { return hashed_text(protocol, participant, trial); });
}

// `kind`: a trial of the block, without its stimulus.
std::vector<StudyTrial> trials_of_block(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                        const std::string& participant, const StudyTrial& kind) {
  std::vector<StudyTrial> trials;
  for (const schema::CodedStimulus& stimulus : key.stimuli)
    for (int i = 1; i <= protocol.repetitions && is_presented(protocol, stimulus); ++i)
      trials.push_back({stimulus.code, i, kind.block, kind.real, 1});
  for (StudyTrial& trial : trials) {
    const std::string text = hashed_text(protocol, participant, trial);
    if (protocol.task == schema::Task::amplitude)
      trial.ratio = protocol.largest_ratio * uniform_by_sum(text + "/ratio");
    if (protocol.task == schema::Task::adjustment) trial.ratio = start_ratio(protocol, trial, text);
  }
  return sorted_by_sum(std::move(trials),
                       [&](const StudyTrial& trial) { return hashed_text(protocol, participant, trial); });
}

// A block for each sample. Half of its trials play the sample's own texture.
std::vector<StudyTrial> beside_samples(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                       const std::string& participant) {
  std::vector<StudyTrial> trials;
  const auto samples = sorted_by_sum(key.stimuli, [&](const schema::CodedStimulus& each) {
    return fmt::format("{}/{}/sample/{}", protocol.seed, participant, each.code);
  });
  const int others = static_cast<int>(samples.size()) - 1;
  int number = 0;
  for (const schema::CodedStimulus& sample : samples) {
    ++number;
    std::vector<StudyTrial> block;
    for (const schema::CodedStimulus& played : key.stimuli)
      for (int i = 1; i <= protocol.repetitions * (played.code == sample.code ? others : 1); ++i)
        block.push_back({played.code, i, number, false, 1, false, sample.code});
    block = sorted_by_sum(std::move(block),
                          [&](const StudyTrial& trial) { return hashed_text(protocol, participant, trial); });
    trials.insert(trials.end(), block.begin(), block.end());
  }
  return trials;
}

}  // namespace

std::vector<StudyTrial> ordered_trials(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                       const std::string& participant, int order) {
  if (protocol.method != schema::LevelMethod::constant) return adaptive_trials(protocol, participant);
  if (protocol.task == schema::Task::ordering) return orderings(protocol, key, participant);
  if (protocol.task == schema::Task::fidelity) return beside_samples(protocol, key, participant);
  if (protocol.task != schema::Task::identification)
    return trials_of_block(protocol, key, participant, {{}, 0, 1, false, 1});
  std::vector<StudyTrial> trials;
  StudyTrial kind;
  for (const std::size_t condition : williams_row(protocol.conditions.size(), order)) {
    kind.real = protocol.conditions[condition] == schema::kRealCondition;
    std::vector<StudyTrial> block = trials_of_block(protocol, key, participant, kind);
    block.resize(std::min(block.size(), static_cast<std::size_t>(protocol.most_trials)));
    trials.insert(trials.end(), block.begin(), block.end());
    ++kind.block;
  }
  return trials;
}

std::vector<StudyTrial> practice_trials(const std::vector<StudyTrial>& trials, int count) {
  const auto end = std::ranges::find_if(
      trials, [&](const StudyTrial& each) { return each.block != trials.front().block; });
  std::vector<StudyTrial> practice(end - std::min<std::ptrdiff_t>(end - trials.begin(), count), end);
  for (StudyTrial& trial : practice) trial.block = 0;
  return practice;
}

std::vector<schema::CodedStimulus> stimuli_by_code(const schema::Protocol& protocol) {
  std::vector<schema::CodedStimulus> stimuli;
  for (const std::string& name : protocol.standards) stimuli.push_back({{}, 0, name, {}});
  for (const double stretch : protocol.levels) stimuli.push_back({{}, stretch, {}, {}});
  if (protocol.task == schema::Task::two_interval) stimuli.push_back({{}, 0, {}, {}});
  stimuli = sorted_by_sum(std::move(stimuli), [&](const schema::CodedStimulus& each) {
    return fmt::format("{}/code/{}", protocol.seed,
                       each.name.empty() ? fmt::format("{:g}", each.stretch) : each.name);
  });
  for (std::size_t i = 0; i < stimuli.size(); ++i) stimuli[i].code = fmt::format("K{}", i + 1);
  return stimuli;
}

double uniform_by_sum(const std::string& text) {
  const std::string sum = schema::sha256_of(text);
  return (static_cast<double>(std::stoull(sum.substr(0, 13), nullptr, 16)) + 0.5) / 0x1p52;
}

std::vector<std::size_t> williams_row(std::size_t count, int row) {
  const auto shift = static_cast<std::size_t>(row - 1);
  std::vector<std::size_t> conditions;
  for (std::size_t i = 0; i < count; ++i)
    conditions.push_back(((i % 2 == 1 ? (i + 1) / 2 : count - i / 2) + shift) % count);
  if (shift >= count) std::ranges::reverse(conditions);
  return conditions;
}

int williams_rows(std::size_t count) {
  return static_cast<int>(count % 2 == 0 ? count : 2 * count);
}

}  // namespace tacto::analysis
