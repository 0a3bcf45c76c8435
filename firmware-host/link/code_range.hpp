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

/// From a channel's physical range, scale and offset; without a range, the ends of 32 bits.
CodeRange code_range(const schema::Channel& channel);

/// The number of codes at an end, in interleaved whole frames.
std::uint64_t clipped_codes(std::span<const std::int32_t> interleaved,
                            std::span<const schema::Channel> channels);

}  // namespace tacto::firmware_host
