// SPDX-License-Identifier: GPL-3.0-or-later
// The gaps of a journal that lost lines, made consistent. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

struct AgreedGaps {
  std::vector<Gap> gaps;     ///< growing, none of them twice
  std::size_t left_out = 0;  ///< of those that contradicted the ones before them
  std::uint64_t untold = 0;  ///< missing frames without a line, added to the gap after them
};

/// A gap's device_sequence counts all missing frames before its first frame: from it one sees that an earlier
/// line is lost, or that a line is there twice. Precondition: gaps of frames that exist.
AgreedGaps agreed_gaps(const std::vector<Gap>& gaps);

}  // namespace tacto::schema
