// SPDX-License-Identifier: GPL-3.0-or-later
// A USB device port as the cable: bytes to and from the host over FunctionFS, also after unplugging, reset
// and replugging.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "data-schema/base/error.hpp"
#include "firmware-host/gadget/board_link.hpp"
#include "firmware-host/link/file_descriptor.hpp"

namespace tacto::firmware_host {

// The descriptors of the interface for FunctionFS, as bytes: USB 2.0 sections 9.6.5 and 9.6.6, USB 3.2
// section 9.6.7, and the kernel's linux/usb/functionfs.h.

/// One interface with its three numbers (core/firmware/usb_identity.hpp), a bulk IN and then a bulk OUT
/// endpoint, at full, high and super speed. The kernel assigns the addresses.
std::vector<std::uint8_t> functionfs_descriptors();
/// The interface's name, in English.
std::vector<std::uint8_t> functionfs_strings(std::string_view interface_name);

struct FunctionFs {
  FileDescriptor events;  ///< ep0
  FileDescriptor in;      ///< to the host
  FileDescriptor out;     ///< from the host
};

/// Mounts the function `instance` privately, writes the descriptors of the interface, opens its files. The
/// mount disappears when they are closed, however the process ends. Errors: device: no permission, no such
/// function, or the kernel refuses the descriptors.
schema::Result<FunctionFs> open_functionfs(const std::string& instance);

/// Three threads: the kernel's events, output, input. While no host has configured the device, output is
/// dropped. When the queue is empty, the transfer to the host ends with a short packet, if necessary an empty
/// one.
class UsbLink final : public BoardLink {
 public:
  /// `say` gets events as text for the user, from any thread.
  UsbLink(FunctionFs files, std::function<void(const std::string&)> say);
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;
  /// Precondition: the gadget is unbound, so that no thread blocks.
  ~UsbLink() override;

  void send(std::span<const std::uint8_t> bytes) override;
  std::size_t waiting() const override { return to_host_.waiting(); }
  void take_received(std::vector<std::uint8_t>& bytes) override;
  void wait_until(Clock::time_point time) override;

 private:
  void watch_events();
  void handle_event();
  void come_up();
  void go_down(const char* why);
  void refuse_setup(bool in) const;
  void send_bursts();
  bool send_burst(const Burst& burst);
  bool input_is_full();
  void receive_bursts();

  FunctionFs files_;
  std::function<void(const std::string&)> say_;
  std::atomic<bool> stopping_ = false, up_ = false;
  std::atomic<std::size_t> packet_ = 0;  // bytes, at the current speed
  BurstQueue to_host_;
  std::mutex mutex_;  // of from_host_ and fresh_
  std::condition_variable came_;
  std::vector<std::uint8_t> from_host_;
  bool fresh_ = false;  // bytes have arrived since the last wait
  std::thread events_thread_, send_thread_, receive_thread_;
};

}  // namespace tacto::firmware_host
