// SPDX-License-Identifier: GPL-3.0-or-later
// Messages for libusb's errors, with the remedy.
#pragma once

#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// `code` is a libusb_error; `doing` is the operation, as in "opening the device". "Not permitted" becomes
/// not_found, as for files; all others become device.
tl::unexpected<schema::Error> usb_failure(int code, std::string_view doing, const std::string& where);

}  // namespace tacto::firmware_host
