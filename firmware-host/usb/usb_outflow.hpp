// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes to a device on USB, one transfer after the other.
#pragma once

#include <span>
#include <vector>

#include "firmware-host/usb/usb_connection.hpp"

namespace tacto::firmware_host {

/// A transfer ends with a short packet, or one of no bytes where its size is a multiple of a packet's. One
/// thread.
class UsbOutflow {
 public:
  /// The connection outlives it.
  explicit UsbOutflow(const UsbConnection& connection);
  UsbOutflow(const UsbOutflow&) = delete;
  UsbOutflow& operator=(const UsbOutflow&) = delete;
  ~UsbOutflow();

  /// Waits until the device has taken all bytes; other transfers complete meanwhile. What stalls or is cut
  /// short is sent again, whole: the wire's decoder finds it behind what came of it before. Errors: device:
  /// gone, stalls three times, or took it not within `timeout_s`.
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s);

 private:
  static void LIBUSB_CALL gone(libusb_transfer* transfer);
  schema::Result<void> send(double timeout_s);
  bool sent_whole() const;
  schema::Result<void> clear();
  schema::Result<void> await_end();

  const UsbConnection& connection_;
  UsbPointer<libusb_transfer> transfer_;
  std::vector<std::uint8_t> buffer_;
  bool under_way_ = false;
  int done_ = 0;
};

}  // namespace tacto::firmware_host
