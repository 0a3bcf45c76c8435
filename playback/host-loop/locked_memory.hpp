// SPDX-License-Identifier: GPL-3.0-or-later
// Memory that is never paged out.
#pragma once

#include <sys/mman.h>

namespace tacto::playback {

/// Locks the memory that this process has now; memory allocated later is locked by the next call. Returns
/// false if this is not permitted (RLIMIT_MEMLOCK): playback still works, but a tick may wait for the disk.
inline bool lock_memory() noexcept {
  return mlockall(MCL_CURRENT) == 0;
}

}  // namespace tacto::playback
