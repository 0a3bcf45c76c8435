// SPDX-License-Identifier: GPL-3.0-or-later
// What systemd wants to hear: a datagram to $NOTIFY_SOCKET (sd_notify(3)); nothing without it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tacto::playback {

class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET and WATCHDOG_USEC.
  ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  ~ServiceManager();

  /// "READY=1", "STOPPING=1", "STATUS=playing oak".
  void tell(std::string_view assignment) const;
  /// As often as is asked for: at half the watchdog's time. Call it often.
  void feed_watchdog(double now_s);

 private:
  std::string address_;
  int descriptor_ = -1;
  double watchdog_s_ = 0, next_s_ = 0;
};

}  // namespace tacto::playback
