// SPDX-License-Identifier: GPL-3.0-or-later
// libusb's errors in words for people, with what to do.
#pragma once

#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// `code` is a libusb_error; `doing` what was tried, as "opening the device". Not permitted is not_found, as
/// with files; all else is device.
tl::unexpected<schema::Error> usb_failure(int code, std::string_view doing, const std::string& where);

}  // namespace tacto::firmware_host
