// SPDX-License-Identifier: GPL-3.0-or-later
// The level of the next trial, from the answers so far: staircases and QUEST+.
#pragma once

#include <string>
#include <vector>

#include "analysis/experiment/trial_queue.hpp"

namespace tacto::analysis {

/// The code of the stimulus. Only attempts that count have an effect: what was not delivered is left
/// out. QUEST+: a cumulative normal function with 21 points of subjective equality within half of the
/// largest stretch to both sides, 16 JNDs from a twentieth of it to all of it (logarithmic), and 2 % lapses;
/// the prior is flat. Precondition: two intervals, of a method that is not constant. Pure: a resumed run gets
/// the same.
std::string adaptive_code(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                          const std::vector<Attempt>& attempts);

/// Of a staircase: the stretches at which its direction changed.
std::vector<double> reversals_of(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                 const std::vector<Attempt>& attempts);

}  // namespace tacto::analysis
