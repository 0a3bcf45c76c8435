// SPDX-License-Identifier: GPL-3.0-or-later
// An open USB device with its interface claimed.
#pragma once

#include <memory>
#include <string>

#include "firmware-host/usb/usb_find.hpp"

namespace tacto::firmware_host {

/// A session with libusb. It scans the bus at the start, which takes milliseconds. Errors: device.
schema::Result<std::shared_ptr<libusb_context>> begin_usb();

/// For one thread. Its transfers must have ended before it is destroyed.
class UsbConnection {
 public:
  /// Errors: as choose_usb(); not_found: this user may not open it; device: another program uses it, or it
  /// fails.
  static schema::Result<UsbConnection> open(const UsbAddress& address);
  UsbConnection(UsbConnection&&) = default;
  UsbConnection& operator=(UsbConnection&&) = delete;
  ~UsbConnection();

  libusb_device_handle* handle() const { return handle_.get(); }
  const UsbInterface& interface() const { return interface_; }
  /// The URI that distinguishes it from all other devices at that time.
  const std::string& uri() const { return uri_; }
  /// Completes transfers until one has set `done` or the time is over.
  schema::Result<void> handle_events(double timeout_s, int& done) const;

 private:
  UsbConnection() = default;
  schema::Result<void> claim(const UsbFound& found);

  std::shared_ptr<libusb_context> context_;
  UsbPointer<libusb_device_handle> handle_;
  UsbInterface interface_;
  std::string uri_;
};

}  // namespace tacto::firmware_host
