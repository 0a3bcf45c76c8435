// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/terminal_keys.hpp"

#include <poll.h>
#include <unistd.h>

namespace tacto::cli {

TerminalKeys::TerminalKeys() {
  // A background process that changes the terminal's settings is stopped by the kernel.
  terminal_ = isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp() &&
              tcgetattr(STDIN_FILENO, &before_) == 0;
  if (!terminal_) return;
  termios keys = before_;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  terminal_ = tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
}

TerminalKeys::~TerminalKeys() {
  if (terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

char TerminalKeys::next() {
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (!terminal_ || poll(&waiting, 1, 0) != 1 || read(STDIN_FILENO, &key, 1) != 1) return 0;
  return key;
}

}  // namespace tacto::cli
