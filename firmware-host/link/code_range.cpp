// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/link/code_range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tacto::firmware_host {
namespace {

std::int32_t code_of(double code) {
  constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::clamp(std::round(code), kLeast, kMost));
}

}  // namespace

CodeRange code_range(const schema::Channel& channel) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double low = (channel.range_min.value_or(-kInfinity) - channel.offset) / channel.scale;
  const double high = (channel.range_max.value_or(kInfinity) - channel.offset) / channel.scale;
  return {code_of(std::min(low, high)), code_of(std::max(low, high))};
}

std::uint64_t clipped_codes(std::span<const std::int32_t> interleaved,
                            std::span<const schema::Channel> channels) {
  std::uint64_t clipped = 0;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const CodeRange range = code_range(channels[k]);
    for (std::size_t i = k; i < interleaved.size(); i += channels.size())
      clipped += range.clips(interleaved[i]);
  }
  return clipped;
}

}  // namespace tacto::firmware_host
