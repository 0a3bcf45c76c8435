// SPDX-License-Identifier: GPL-3.0-or-later
// Intentional faults of a device, so that hosts can be tested.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// No faults by default. `every` counts messages of samples, from 1; `after` counts all frames that the
/// device has sent since its start, and the fault occurs once.
struct FaultPlan {
  std::optional<std::uint64_t> corrupt_every;       ///< one bit is inverted
  std::optional<std::uint64_t> drop_every;          ///< left out
  std::optional<std::uint64_t> truncate_every;      ///< its second half is left out
  std::optional<std::uint64_t> repeat_every;        ///< sent twice
  std::optional<std::uint64_t> packet;              ///< the largest size of a transfer in bytes
  std::optional<std::uint64_t> stall_after;         ///< the endpoint to the host stalls
  std::optional<std::uint64_t> unplug_after;        ///< in the middle of a frame
  std::optional<std::uint64_t> silent_after;        ///< nothing more is sent, but the device stays plugged in
  std::optional<std::uint64_t> stop_reading_after;  ///< nothing more is received, after so many transfers
  std::optional<std::uint8_t> major;                ///< the protocol version in its welcome
  std::uint8_t minor = 0;
};

/// "corrupt-every=100,version=2.0": see fault_words(). Errors: usage: a key that does not exist (with those
/// that do), a value that is not a number.
schema::Result<FaultPlan> parse_fault_plan(std::string_view text);
/// One line per key, for help.
std::string fault_words();

}  // namespace tacto::firmware_host
