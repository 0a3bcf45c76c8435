// SPDX-License-Identifier: GPL-3.0-or-later
// An encoder watched while somebody moves it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capture/record/take.hpp"

namespace tacto::capture {

struct WatchedCounts {
  Take take;                   ///< the device's words, no frames
  std::vector<double> counts;  ///< at each mark
};

/// Streams without a break, so that no count is missed, and asks `marked` after each 20 ms; where it says
/// yes, the count at the end of them is kept, until there are so many. Errors: usage: no such channel;
/// device: as of Device, or its stream ended; those
/// of `marked`.
schema::Result<WatchedCounts> watch_counts(firmware_host::Device& device, const std::string& channel,
                                           std::size_t marks,
                                           const std::function<schema::Result<bool>()>& marked);

}  // namespace tacto::capture
