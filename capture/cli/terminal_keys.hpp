// SPDX-License-Identifier: GPL-3.0-or-later
// Keys pressed while something else goes on.
#pragma once

#include <termios.h>

namespace tacto::capture {

/// While it lives, a terminal on stdin gives keys as they are pressed, unechoed; Ctrl-C stays a signal. Where
/// stdin is no terminal there are no keys.
class TerminalKeys {
 public:
  TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;
  ~TerminalKeys();

  /// The next key that is waiting, 0 where none is.
  char next();

 private:
  bool terminal_ = false;
  termios before_{};
};

}  // namespace tacto::capture
