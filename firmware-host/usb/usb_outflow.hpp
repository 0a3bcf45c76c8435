// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes to a device on USB, one transfer after the other.
#pragma once

#include <span>
#include <vector>

#include "firmware-host/usb/usb_connection.hpp"

namespace tacto::firmware_host {

/// A transfer ends with a short packet, or an empty one if its size is a multiple of the packet size. For one
/// thread.
class UsbOutflow {
 public:
  /// The connection must outlive this object.
  explicit UsbOutflow(const UsbConnection& connection);
  UsbOutflow(const UsbOutflow&) = delete;
  UsbOutflow& operator=(const UsbOutflow&) = delete;
  ~UsbOutflow();

  /// Waits until the device has received all bytes; other transfers complete in the meantime. A transfer that
  /// stalls or is truncated is sent again as a whole: the wire's decoder finds it after the incomplete one.
  /// Errors: device: gone, three stalls, or not received within `timeout_s`.
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
