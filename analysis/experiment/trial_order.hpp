// SPDX-License-Identifier: GPL-3.0-or-later
// The order of the trials, which anyone can compute with sha256sum and sort.
#pragma once

#include <string>
#include <vector>

#include "data-schema/experiment/protocol.hpp"

namespace tacto::analysis {

struct StudyTrial {
  std::string code;  ///< of the stretched stimulus, the comparison or the standard; of ordering "all"
  int repetition = 0;
  int block = 1;            ///< 0: practice
  bool real = false;        ///< a sample on the bench, instead of playback
  double ratio = 1;         ///< its gain over that of the protocol; of adjustment, the gain at its start
  bool adaptive = false;    ///< its code is chosen when its turn comes
  std::string sample = {};  ///< of fidelity: the code of the real sample beside it
  std::vector<std::string> arranged = {};  ///< of ordering: the codes of the first, second ... texture

  std::string name() const { return code + "." + std::to_string(repetition); }
  bool standard_comes_first() const { return repetition % 2 == 1; }
  bool is_practice() const { return block == 0; }
  bool is_ascending() const { return repetition % 2 == 1; }  ///< of adjustment: it begins at low gains
};

/// All trials of a participant. Those of each block are sorted by the SHA-256 of
/// SEED/PARTICIPANT/BLOCK/CODE.REPETITION. two_interval and amplitude have one block, 1; the blocks of an
/// identification are its conditions, in the order of row `order` of their Williams square, and each has its
/// first most_trials trials. The ratio of a trial of amplitude is largest_ratio times uniform_by_sum() of
/// that text with /ratio at its end. Of an adaptive method CODE is "level" in that order. The textures of a
/// trial of ordering are sorted by the SHA-256 of that text with /CODE at its end. An adjustment starts at
/// uniform_by_sum() of that text with /start at its end, times a quarter of the range of ratios in dB, from
/// its lower end in odd repetitions, from its upper one in even ones. A fidelity has a block for each sample,
/// sorted by the SHA-256 of SEED/PARTICIPANT/sample/CODE.
std::vector<StudyTrial> ordered_trials(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                                       const std::string& participant, int order);

/// The last `count` of the first block, as block 0: those that come latest again. Precondition: `trials`
/// begins with that block.
std::vector<StudyTrial> practice_trials(const std::vector<StudyTrial>& trials, int count);

/// The stimuli of a protocol, in the order of their codes K1, K2 ...: sorted by the SHA-256 of
/// SEED/code/STRETCH, with the stretch as in 0.3, or of SEED/code/NAME. Without their sums.
std::vector<schema::CodedStimulus> stimuli_by_code(const schema::Protocol& protocol);

/// Above 0, below 1: (the first 52 bits of the SHA-256 of the text + 1/2) / 2^52.
double uniform_by_sum(const std::string& text);

/// A row of the Williams square of `count` conditions, from row 1: every condition is at each place equally
/// often, and follows each other one equally often. `count` rows if that is even, else twice as many
/// (Williams 1949, Aust. J. Sci. Res. A 2, 149).
std::vector<std::size_t> williams_row(std::size_t count, int row);
int williams_rows(std::size_t count);

}  // namespace tacto::analysis
