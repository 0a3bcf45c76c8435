// SPDX-License-Identifier: GPL-3.0-or-later
// Owning pointers for objects of libusb.
#pragma once

#include <libusb.h>

#include <memory>

namespace tacto::firmware_host {

struct UsbDeleter {
  void operator()(libusb_context* context) const { libusb_exit(context); }
  void operator()(libusb_device* device) const { libusb_unref_device(device); }
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
  void operator()(libusb_config_descriptor* descriptor) const { libusb_free_config_descriptor(descriptor); }
  void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};

template <class Lent>
using UsbPointer = std::unique_ptr<Lent, UsbDeleter>;

}  // namespace tacto::firmware_host
