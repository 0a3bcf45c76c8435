// SPDX-License-Identifier: GPL-3.0-or-later
// What was prepared, as commands of the wire.
#pragma once

#include <algorithm>
#include <span>
#include <string>

#include "firmware-host/core/wire/crc32c.hpp"
#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/core/wire/host_messages.hpp"
#include "playback/prepare.hpp"

namespace tacto::playback {

/// Errors: unsuitable, where the device can't hold the texture, or does not tick at the rate.
schema::Result<void> check_fits(const Prepared& prepared, const wire::Welcome& device,
                                const std::string& uri);

/// Limits never wider than the device's own.
wire::Limits limits_for(const Prepared& prepared, const wire::Welcome& device);
wire::Texture texture_message(const Prepared& prepared);
wire::Taps taps_message(const Prepared& prepared);
wire::ProfileBegin begin_message(const Prepared& prepared);
wire::Arm arm_message(const Prepared& prepared);
std::uint32_t check_of(std::span<const float> samples);

/// Calls `send` with each command in order, until one fails.
template <class Send>
schema::Result<void> for_each_message(const Prepared& prepared, const wire::Welcome& device, Send send) {
  if (const auto done = send(limits_for(prepared, device)); !done) return done;
  if (const auto done = send(texture_message(prepared)); !done) return done;
  if (const auto done = send(taps_message(prepared)); !done) return done;
  if (const auto done = send(wire::Filters{}); !done) return done;
  if (const auto done = send(begin_message(prepared)); !done) return done;
  wire::ProfileChunk chunk;
  for (std::size_t at = 0; at < prepared.samples.size(); at += chunk.count) {
    chunk.first = static_cast<std::uint32_t>(at);
    chunk.count = static_cast<std::uint16_t>(std::min(wire::kMaxChunk, prepared.samples.size() - at));
    std::copy_n(prepared.samples.begin() + static_cast<std::ptrdiff_t>(at), chunk.count, chunk.values);
    if (const auto done = send(chunk); !done) return done;
  }
  return send(wire::ProfileEnd{check_of(prepared.samples)});
}

}  // namespace tacto::playback
