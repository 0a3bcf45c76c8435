// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the next stimulus of an adaptive procedure: QUEST+, Watson 2017 (J. of Vision 17(3):10).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace tacto::analysis {

/// The posterior over a grid of parameters. Each trial has the stimulus with the least expected entropy of
/// the posterior after its answer. Pure; a choice takes time in proportion to stimuli times parameters.
class QuestPlus {
 public:
  /// `chance(stimulus, parameters)` is the probability of "yes", both by index. The prior is flat.
  QuestPlus(std::size_t stimuli, std::size_t parameters,
            const std::function<double(std::size_t, std::size_t)>& chance);

  /// The stimulus to present: the first of those whose entropies are the least, but for rounding (2e-15). A
  /// tolerance of 1e-12 would choose another stimulus than the published runs in two trials of 352.
  std::size_t next() const;
  void take_answer(std::size_t stimulus, bool yes);

  const std::vector<double>& posterior() const { return posterior_; }
  /// The parameters with the largest probability.
  std::size_t mode() const;

 private:
  double expected_entropy(std::size_t stimulus) const;

  std::vector<std::vector<double>> chances_;  // of each stimulus: by parameters
  std::vector<double> posterior_;
};

}  // namespace tacto::analysis
