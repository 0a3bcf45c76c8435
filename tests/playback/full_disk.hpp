// SPDX-License-Identifier: GPL-3.0-or-later
// A limit of the file size that simulates a full disk.
#pragma once

#include <sys/resource.h>

namespace tacto::playback {

/// While the object exists, this process cannot write a file beyond this number of bytes.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace tacto::playback
