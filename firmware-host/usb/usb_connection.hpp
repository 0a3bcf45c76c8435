// SPDX-License-Identifier: GPL-3.0-or-later
// An opened device on USB, its interface claimed.
#pragma once

#include <memory>
#include <string>

#include "firmware-host/usb/usb_find.hpp"

namespace tacto::firmware_host {

/// A session with libusb. It looks at the bus when it begins, which takes milliseconds. Errors: device.
schema::Result<std::shared_ptr<libusb_context>> begin_usb();

/// One thread. Transfers on it must have ended before it does.
class UsbConnection {
 public:
  /// Errors: as choose_usb(); not_found: this user may not open it; device: another program has it, or it
  /// fails.
  static schema::Result<UsbConnection> open(const UsbAddress& address);
  UsbConnection(UsbConnection&&) = default;
  UsbConnection& operator=(UsbConnection&&) = delete;
  ~UsbConnection();

  libusb_device_handle* handle() const { return handle_.get(); }
  const UsbInterface& interface() const { return interface_; }
  /// The URI that tells it from all others there were.
  const std::string& uri() const { return uri_; }
  /// Lets transfers complete, until one has set `done` or the time is over.
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
