// SPDX-License-Identifier: GPL-3.0-or-later
// An open USB device with its interface claimed.
#pragma once

#include <libusb.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware-host/usb/usb_address.hpp"

namespace tacto::firmware_host {

/// A session with libusb. It scans the bus at the start, which takes milliseconds. Errors: device.
schema::Result<std::shared_ptr<libusb_context>> begin_usb();

/// Owning pointers for objects of libusb.
struct UsbDeleter {
  void operator()(libusb_context* context) const { libusb_exit(context); }
  void operator()(libusb_device* device) const { libusb_unref_device(device); }
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
  void operator()(libusb_config_descriptor* descriptor) const { libusb_free_config_descriptor(descriptor); }
  void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};

template <class Lent>
using UsbPointer = std::unique_ptr<Lent, UsbDeleter>;

/// The interface of the wire among those of a device.
struct UsbInterface {
  std::uint8_t number = 0, setting = 0;
  std::uint8_t in = 0, out = 0;  ///< addresses of the bulk endpoints
};

struct UsbFound {
  UsbName name;
  UsbInterface interface;
  UsbPointer<libusb_device> device;
};

/// Every USB device with an interface of the wire, of any vendor, in the order of buses and ports, with its
/// serial if this user may read it. Errors: device: the bus cannot be read.
schema::Result<std::vector<UsbFound>> find_usb(libusb_context* context);

std::vector<UsbName> names_of(const std::vector<UsbFound>& found);

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
