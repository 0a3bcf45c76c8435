// SPDX-License-Identifier: GPL-3.0-or-later
// The order of the trials, which anyone can compute with sha256sum and sort.
#pragma once

#include <string>
#include <vector>

#include "data-schema/experiment/protocol.hpp"

namespace tacto::analysis {

struct StudyTrial {
  std::string code;  ///< of the stretched stimulus
  int repetition = 0;

  std::string name() const { return code + "." + std::to_string(repetition); }
  bool standard_comes_first() const { return repetition % 2 == 1; }
};

/// All trials of a participant, sorted by the SHA-256 of SEED/PARTICIPANT/BLOCK/CODE.REPETITION. There is one
/// block, 1.
std::vector<StudyTrial> ordered_trials(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                       const std::string& participant);

/// The stretches of a protocol, with the standard's 0, in the order of their codes K1, K2 ...: sorted by the
/// SHA-256 of SEED/code/STRETCH, with the stretch as in 0.3.
std::vector<double> stretches_by_code(const schema::Protocol& protocol);

}  // namespace tacto::analysis
