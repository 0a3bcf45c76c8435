// SPDX-License-Identifier: GPL-3.0-or-later
// The process that writes a file, as part of the file's name, and whether it still runs.
#pragma once

#include <sys/types.h>

#include <ctime>
#include <optional>
#include <string>
#include <string_view>

namespace tacto::schema {

/// Identifies a process among all that may write into a folder, also where machines or containers share it.
struct ProcessMark {
  std::string machine;  ///< 8 hexadecimal digits: host name, machine id and space of process numbers
  std::string boot;     ///< 8 hexadecimal digits of the kernel's boot id
  pid_t pid = 0;
  unsigned long long start = 0;  ///< when the process began, in the kernel's ticks since boot
};

enum class Liveness {
  runs,
  ended,
  unknown,  ///< another machine or container, or no /proc: it may run
};

/// This process. Without /proc, machine and boot are zeros, and its liveness is unknown to all.
const ProcessMark& own_mark();

/// "1a2b3c4d-5e6f7a8b-4711-123456".
std::string text_of(const ProcessMark& mark);

/// Reads text made by text_of(); nullopt for other text.
std::optional<ProcessMark> parse_mark(std::string_view text);

/// Whether the process of a mark runs. `last_change`: when its file was last changed. After a restart of this
/// machine, a file that was changed since then belongs to another machine with the same name.
Liveness liveness_of(const ProcessMark& mark, std::time_t last_change);

}  // namespace tacto::schema
