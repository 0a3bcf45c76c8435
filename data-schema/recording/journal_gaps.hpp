// SPDX-License-Identifier: GPL-3.0-or-later
// The gaps of a journal that lost lines, made to agree with one another. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

struct AgreedGaps {
  std::vector<Gap> gaps;     ///< growing, none of them twice
  std::size_t left_out = 0;  ///< of those that contradicted the ones before them
  std::uint64_t untold = 0;  ///< missing frames that no line told of, added to the gap after them
};

/// A gap's device_sequence counts all missing frames before its first frame: it shows that a line before it
/// is lost, and that a line is there twice. Precondition: gaps of frames that are there.
AgreedGaps agreed_gaps(const std::vector<Gap>& gaps);

}  // namespace tacto::schema
