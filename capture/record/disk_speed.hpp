// SPDX-License-Identifier: GPL-3.0-or-later
// How fast a folder's disk takes what a recording gives it.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

struct DiskSpeed {
  double free_bytes = 0;
  double write_bytes_per_s = 0;                ///< 16 MB, brought to the disk
  double sync_median_s = 0, sync_worst_s = 0;  ///< of 20 blocks as a recording syncs them
};

/// Writes to a file without a name's trace: it is gone when this returns, or dies. `block_bytes` is what a
/// recording brings to the disk at once. Takes what the disk takes, some 0.1 s. Errors: cannot_write: the
/// folder is not there or may not be written to, or the disk is full.
schema::Result<DiskSpeed> measure_disk(const std::string& folder, std::size_t block_bytes);

}  // namespace tacto::capture
