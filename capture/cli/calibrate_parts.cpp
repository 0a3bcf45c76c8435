// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/cli/calibrate_parts.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include "data-schema/report/terminal.hpp"

namespace tacto::capture {
namespace {

// Byte by byte, so that no byte of the next line is consumed.
schema::Result<bool> read_line() {
  char byte = 0;
  while (read(STDIN_FILENO, &byte, 1) == 1)
    if (byte == '\n') return true;
  return schema::fail(schema::ErrorKind::usage, "the input ended before Enter was pressed", "stdin",
                      "run it in a terminal, or calibrate from recordings (--help)");
}

}  // namespace

schema::Result<void> wait_for_enter(const std::string& what_to_do) {
  cli::write_message(fmt::format("{}, then press Enter: ", what_to_do));
  std::fflush(stderr);
  const auto line = read_line();
  return line ? schema::Result<void>{} : schema::forward_error(line);
}

schema::Result<bool> enter_was_pressed() {
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  if (poll(&waiting, 1, 0) != 1) return false;
  return read_line();
}

}  // namespace tacto::capture
