// SPDX-License-Identifier: GPL-3.0-or-later
// The settings of a serial port that carries the wire.
#pragma once

#include <termios.h>

namespace tacto::firmware_host {

/// 8 data bits, no parity, one stop bit, no flow control; bytes pass unchanged, in both directions.
inline termios raw_settings(termios settings) {
  ::cfmakeraw(&settings);
  settings.c_cflag |= CREAD | CLOCAL;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  return settings;
}

}  // namespace tacto::firmware_host
