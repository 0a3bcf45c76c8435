// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an encoder at marks while it is moved by hand.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capture/record/take.hpp"

namespace tacto::capture {

struct WatchedCounts {
  Take take;                   ///< the description of the device, without frames
  std::vector<double> counts;  ///< one at each mark
};

/// Streams without interruption, so that no count is missed, and calls `marked` every 20 ms. If it returns
/// true, the count at the end of these 20 ms is kept, until there are `marks` counts. Errors: usage: no such
/// channel; device: as in Device, or its stream ended; those of `marked`.
schema::Result<WatchedCounts> watch_counts(firmware_host::Device& device, const std::string& channel,
                                           std::size_t marks,
                                           const std::function<schema::Result<bool>()>& marked);

}  // namespace tacto::capture
