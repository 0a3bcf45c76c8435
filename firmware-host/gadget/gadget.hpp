// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph-gadget: a Linux board with a USB device port as a device, or an emulated board on a
// pseudo-terminal.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "firmware-host/gadget/board_link.hpp"

namespace tacto::firmware_host {

/// What the program of the tests changes, which simulates faults of a device.
struct GadgetHooks {
  std::function<std::unique_ptr<BoardLink>(BoardLink& link)> wrap;  ///< the board gets this link instead
  std::optional<std::uint64_t> stop_reading_after;                  ///< as UsbLink::Settings
};

/// The program, without its name in `arguments`; returns its exit code.
int run_gadget(std::span<const char* const> arguments, const GadgetHooks& hooks = {});

}  // namespace tacto::firmware_host
