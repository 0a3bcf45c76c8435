// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_connection.hpp"

#include <cmath>

#include "firmware-host/usb/usb_words.hpp"

namespace tacto::firmware_host {

using schema::Result;

Result<std::shared_ptr<libusb_context>> begin_usb() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != 0)
    return usb_failure(code, "initialising USB", "device");
  return std::shared_ptr<libusb_context>(context, UsbDeleter());
}

// The connection is created first, because it owns the libusb session of the found devices.
Result<UsbConnection> UsbConnection::open(const UsbAddress& address) {
  auto context = begin_usb();
  TACTO_TRY(context);
  UsbConnection connection;
  connection.context_ = std::move(*context);
  const auto found = find_usb(connection.context_.get());
  TACTO_TRY(found);
  const std::vector<UsbName> names = names_of(*found);
  const auto chosen = choose_usb(names, address);
  TACTO_TRY(chosen);
  connection.uri_ = usb_uri(names, *chosen);
  TACTO_TRY(connection.claim((*found)[*chosen]));
  return connection;
}

// Detaches a kernel driver if the system supports it; otherwise claiming returns "busy".
Result<void> UsbConnection::claim(const UsbFound& found) {
  interface_ = found.interface;
  libusb_device_handle* handle = nullptr;
  const int opened = libusb_open(found.device.get(), &handle);
  if (opened != 0) return usb_failure(opened, "opening the device", uri_);
  handle_.reset(handle);
  libusb_set_auto_detach_kernel_driver(handle, 1);
  const int claimed = libusb_claim_interface(handle, interface_.number);
  if (claimed != 0) return usb_failure(claimed, "claiming its interface", uri_);
  if (interface_.setting == 0) return {};
  const int set = libusb_set_interface_alt_setting(handle, interface_.number, interface_.setting);
  if (set != 0) return usb_failure(set, "selecting the setting of its interface", uri_);
  return {};
}

UsbConnection::~UsbConnection() {
  if (handle_) libusb_release_interface(handle(), interface_.number);
}

Result<void> UsbConnection::handle_events(double timeout_s, int& done) const {
  timeval time{};
  time.tv_sec = static_cast<time_t>(timeout_s);
  time.tv_usec = static_cast<suseconds_t>((timeout_s - std::floor(timeout_s)) * 1e6);
  const int code = libusb_handle_events_timeout_completed(context_.get(), &time, &done);
  if (code != 0 && code != LIBUSB_ERROR_INTERRUPTED) return usb_failure(code, "waiting for the device", uri_);
  return {};
}

}  // namespace tacto::firmware_host
