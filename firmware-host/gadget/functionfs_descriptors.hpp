// SPDX-License-Identifier: GPL-3.0-or-later
// The descriptors of the interface for FunctionFS, as bytes: USB 2.0 sections 9.6.5 and 9.6.6, USB 3.2
// section 9.6.7, and the kernel's linux/usb/functionfs.h.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace tacto::firmware_host {

/// One interface with its three numbers (core/firmware/usb_identity.hpp), a bulk IN and then a bulk OUT
/// endpoint, at full, high and super speed. The kernel assigns the addresses.
std::vector<std::uint8_t> functionfs_descriptors();
/// The interface's name, in English.
std::vector<std::uint8_t> functionfs_strings(std::string_view interface_name);

}  // namespace tacto::firmware_host
