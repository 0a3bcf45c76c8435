// SPDX-License-Identifier: GPL-3.0-or-later
// The udev rule that permits users to open the device, for systems without the source tree.
#pragma once

#include <string_view>

namespace tacto::capture {

/// The one line of firmware-host/usb/60-tactograph.rules that is not a comment (a test compares them).
inline constexpr std::string_view kUdevRule =
    R"(SUBSYSTEM=="usb", ENV{DEVTYPE}=="usb_device", ENV{ID_USB_INTERFACES}=="*:ff54??:*", GROUP="plugdev", MODE="0660", TAG+="uaccess")";

}  // namespace tacto::capture
