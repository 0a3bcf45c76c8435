// SPDX-License-Identifier: GPL-3.0-or-later
// Notifies systemd: a datagram to $NOTIFY_SOCKET (sd_notify(3)); does nothing if it is not set.
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

  /// `assignment`: "READY=1", "STOPPING=1", "STATUS=playing oak".
  void tell(std::string_view assignment) const;
  /// Notifies the watchdog at half its time. Call often.
  void feed_watchdog(double now_s);

 private:
  std::string address_;
  int descriptor_ = -1;
  double watchdog_s_ = 0, next_s_ = 0;
};

}  // namespace tacto::playback
