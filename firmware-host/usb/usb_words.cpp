// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_words.hpp"

#include <fmt/format.h>
#include <libusb.h>

namespace tacto::firmware_host {

using schema::ErrorKind;
using schema::fail;

tl::unexpected<schema::Error> usb_failure(int code, std::string_view doing, const std::string& where) {
  switch (code) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return fail(ErrorKind::device, "the device was unplugged", where, "check its cable and its supply");
    case LIBUSB_ERROR_ACCESS:
      return fail(ErrorKind::not_found, "this user may not open the device", where,
                  "install the udev rule 60-tactograph.rules ('cmake --install', or copy it to "
                  "/etc/udev/rules.d), then unplug it and plug it in again");
    case LIBUSB_ERROR_BUSY:
      return fail(ErrorKind::device, "another program uses the device", where, "stop that program");
    case LIBUSB_ERROR_NO_MEM:
      return fail(ErrorKind::device, "the system has no memory for USB transfers", where,
                  "close other USB programs, or raise /sys/module/usbcore/parameters/usbfs_memory_mb");
    default:
      return fail(ErrorKind::device, fmt::format("{} failed: {}", doing, libusb_strerror(code)), where,
                  "unplug it and plug it in again, at another port or with another cable");
  }
}

}  // namespace tacto::firmware_host
