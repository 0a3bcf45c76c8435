// SPDX-License-Identifier: GPL-3.0-or-later
// The device's end of the cable: bytes to and from the host over FunctionFS, through unplugging, reset and
// replugging.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>

#include "firmware-host/gadget/burst_queue.hpp"
#include "firmware-host/gadget/functionfs.hpp"

namespace tacto::firmware_host {

/// Three threads: the kernel's events, bytes out, bytes in. While no host has configured the device, what is
/// sent is dropped. A transfer to the host ends with a short packet, where need be an empty one, as soon as
/// nothing waits.
class UsbLink {
 public:
  using Clock = std::chrono::steady_clock;
  struct Settings {
    std::string port;                             ///< the device port's name
    std::optional<std::uint64_t> deaf_after;      ///< for tests: takes nothing more after so many transfers
    std::function<void(const std::string&)> say;  ///< what happens, for people; from any thread
  };

  UsbLink(FunctionFs files, Settings settings);
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;
  /// Precondition: the gadget is not bound any more, so that nothing blocks.
  ~UsbLink();

  void send(std::span<const std::uint8_t> bytes, BurstEnd end = BurstEnd::none);
  /// Bytes that have not gone yet.
  std::size_t waiting() const { return to_host_.waiting(); }
  /// Appends what has come.
  void take_received(std::vector<std::uint8_t>& bytes);
  /// Until something has come since the last call, or that time.
  void wait_until(Clock::time_point time);

 private:
  void watch_events();
  void handle_event();
  void come_up();
  void go_down(const char* why);
  void refuse_setup(bool in) const;
  void send_bursts();
  bool send_burst(const Burst& burst);
  void do_end(BurstEnd end);
  bool crowded();
  void receive_bursts();

  FunctionFs files_;
  Settings settings_;
  std::atomic<bool> stopping_ = false, up_ = false;
  std::atomic<std::size_t> packet_ = 0;  // bytes, at the speed of now
  BurstQueue to_host_;
  std::mutex mutex_;  // of from_host_ and fresh_
  std::condition_variable came_;
  std::vector<std::uint8_t> from_host_;
  bool fresh_ = false;  // some of it has come since somebody waited
  std::thread events_thread_, send_thread_, receive_thread_;
};

}  // namespace tacto::firmware_host
