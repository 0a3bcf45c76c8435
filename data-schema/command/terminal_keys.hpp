// SPDX-License-Identifier: GPL-3.0-or-later
// Single key presses, read without blocking.
#pragma once

#include <termios.h>

namespace tacto::cli {

/// While this object exists, a terminal on stdin delivers each key at once and without echo; Ctrl-C remains a
/// signal. If stdin is not a terminal, no key is ever delivered.
class TerminalKeys {
 public:
  TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;
  ~TerminalKeys();

  /// The next key in the input, 0 if there is none.
  char next();

 private:
  bool terminal_ = false;
  termios before_{};
};

}  // namespace tacto::cli
