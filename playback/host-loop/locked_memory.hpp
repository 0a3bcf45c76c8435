// SPDX-License-Identifier: GPL-3.0-or-later
// Memory that is never paged out.
#pragma once

#include <sys/mman.h>

namespace tacto::playback {

/// Locks what this process holds by now; what it takes later is locked by the next call. False where it may
/// not (RLIMIT_MEMLOCK): then all works, but a tick may wait for the disk.
inline bool lock_memory() noexcept {
  return mlockall(MCL_CURRENT) == 0;
}

}  // namespace tacto::playback
