// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of the gadget.
#pragma once

#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "firmware-host/core/firmware/usb_identity.hpp"

namespace tacto::firmware_host {

struct GadgetOptions {
  bool help = false;
  std::string board = "sim:";
  std::string serial;  ///< empty: the board's own
  std::string udc;     ///< empty: the first
  std::string pty;     ///< the name of a serial port to make; empty: USB
  std::uint16_t vendor = usb::kTestVendor, product = usb::kTestProduct;
};

/// Errors: usage: an option that does not exist, one without its value, an invalid value.
schema::Result<GadgetOptions> parse_gadget_options(std::span<const char* const> arguments);
std::string gadget_help();

}  // namespace tacto::firmware_host
