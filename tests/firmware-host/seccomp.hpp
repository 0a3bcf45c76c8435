// SPDX-License-Identifier: GPL-3.0-or-later
// Runs code in a process that Linux ends at its first system call.
#pragma once

#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

namespace tacto::tests {

/// Status, as of waitpid(), of a child that runs `work` under seccomp's strict mode: ended by a signal at a
/// system call other than read, write and exit; otherwise its exit code is 0 if `work` returns true.
inline int status_under_seccomp(const std::function<bool()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) _exit(2);
    syscall(SYS_exit, work() ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

}  // namespace tacto::tests
