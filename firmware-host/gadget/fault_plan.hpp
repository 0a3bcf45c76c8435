// SPDX-License-Identifier: GPL-3.0-or-later
// What a device does wrong on purpose, so that a host can be tested.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// Nothing unless asked for. `every` counts messages of samples, from 1; `after` counts all frames that the
/// device sent since it started, and happens once.
struct FaultPlan {
  std::optional<std::uint64_t> corrupt_every;   ///< a bit is turned over
  std::optional<std::uint64_t> drop_every;      ///< left out
  std::optional<std::uint64_t> truncate_every;  ///< its second half is left out
  std::optional<std::uint64_t> repeat_every;    ///< sent twice
  std::optional<std::uint64_t> packet;          ///< no transfer is longer than so many bytes
  std::optional<std::uint64_t> stall_after;     ///< the endpoint to the host stalls
  std::optional<std::uint64_t> unplug_after;    ///< in the middle of a frame
  std::optional<std::uint64_t> silent_after;    ///< nothing more is sent, while the device stays plugged in
  std::optional<std::uint64_t> deaf_after;      ///< nothing more is received, after so many transfers
  std::optional<std::uint8_t> major;            ///< of the protocol that it claims to speak
  std::uint8_t minor = 0;
};

/// "corrupt-every=100,version=2.0": see fault_words(). Errors: usage: a key that does not exist (with those
/// that do), a value that is no number.
schema::Result<FaultPlan> parse_fault_plan(std::string_view text);
/// One line for each key, for people.
std::string fault_words();

}  // namespace tacto::firmware_host
