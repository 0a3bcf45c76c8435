// SPDX-License-Identifier: GPL-3.0-or-later
// The codes at the ends of a converter's range: samples there are clipped.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "data-schema/recording/recording.hpp"

namespace tacto::firmware_host {

struct CodeRange {
  std::int32_t least, most;
  bool clips(std::int32_t code) const { return code <= least || code >= most; }
};

/// From a channel's physical range, scale and offset; of a channel without a range, the ends of 32 bits.
CodeRange code_range(const schema::Channel& channel);

/// How many codes of interleaved whole frames are at an end.
std::uint64_t clipped_codes(std::span<const std::int32_t> interleaved,
                            std::span<const schema::Channel> channels);

}  // namespace tacto::firmware_host
