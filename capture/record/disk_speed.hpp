// SPDX-License-Identifier: GPL-3.0-or-later
// The speed of a folder's disk for writes as a recording makes them.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

struct DiskSpeed {
  double free_bytes = 0;
  double write_bytes_per_s = 0;                ///< of 16 MB, written and synced
  double sync_median_s = 0, sync_worst_s = 0;  ///< of 20 blocks, synced as in a recording
};

/// Writes to an unnamed file, which is gone when this function returns or the process ends. `block_bytes` is
/// the amount that a recording syncs at once. Duration: that of the disk, about 0.1 s. Errors: cannot_write:
/// the folder does not exist or is not writable, or the disk is full.
schema::Result<DiskSpeed> measure_disk(const std::string& folder, std::size_t block_bytes);

}  // namespace tacto::capture
