// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph-gadget: a Linux board with a USB device port as a device, or an emulated board on a
// pseudo-terminal.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "firmware-host/core/firmware/usb_identity.hpp"

namespace tacto::firmware_host {

// The command line of the gadget.

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

/// The program, without its name in `arguments`; returns its exit code.
int run_gadget(std::span<const char* const> arguments);

}  // namespace tacto::firmware_host
