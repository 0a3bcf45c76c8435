// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's interface to a USB function: three files, one for events, one per endpoint.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"
#include "firmware-host/link/file_descriptor.hpp"

namespace tacto::firmware_host {

struct FunctionFs {
  FileDescriptor events;  ///< ep0
  FileDescriptor in;      ///< to the host
  FileDescriptor out;     ///< from the host
};

/// Mounts the function `instance` privately, writes the descriptors of the interface, opens its files. The
/// mount disappears when they are closed, however the process ends. Errors: device: no permission, no such
/// function, or the kernel refuses the descriptors.
schema::Result<FunctionFs> open_functionfs(const std::string& instance);

}  // namespace tacto::firmware_host
