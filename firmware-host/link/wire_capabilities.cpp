// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a device's description to capabilities. A device may send any values; those that cannot be used
// are refused here.
#include <fmt/format.h>

#include <cmath>

#include "firmware-host/link/wire_device.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

std::optional<double> if_number(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

Result<schema::Channel> channel_of(const wire::Channel& said, const std::string& where) {
  const auto quantity = schema::quantity_named(said.quantity);
  if (!quantity)
    return fail(ErrorKind::device,
                fmt::format("its channel {} has an unknown quantity: '{}'", said.index, said.quantity), where,
                quantity.error().remedy);
  if (!std::isfinite(said.scale) || said.scale == 0 || !std::isfinite(said.offset))
    return fail(ErrorKind::device, fmt::format("its channel '{}' has no usable scale or offset", said.name),
                where);
  schema::Channel channel;
  channel.name = said.name;
  channel.quantity = said.quantity;
  channel.unit = said.unit;
  channel.source = said.source;
  channel.scale = said.scale;
  channel.offset = said.offset;
  channel.range_min = if_number(said.range_min);
  channel.range_max = if_number(said.range_max);
  channel.native_rate_hz = if_number(said.native_rate_hz);
  channel.calibrated = said.calibrated;
  return channel;
}

std::string note_of(const Description& description, wire::NoteKind kind) {
  for (const wire::Note& note : description.notes)
    if (note.kind == kind) return note.text;
  return {};
}

// The device, and after a colon the source of its samples.
std::string simulated_samples(const Description& description) {
  std::string said;
  for (const wire::Note& note : description.notes)
    if (note.kind == wire::NoteKind::simulated_by && note.text[0] != '\0')
      said += (said.empty() ? "" : ": ") + std::string(note.text);
  return said;
}

}  // namespace

std::string simulated_device(const Description& description) {
  return note_of(description, wire::NoteKind::simulated_by);
}

Result<Capabilities> capabilities_of(const Description& description, std::string uri) {
  Capabilities capabilities;
  capabilities.sample_rate_hz = 1e-3 * description.welcome.default_rate_millihertz;
  if (capabilities.sample_rate_hz <= 0 || description.channels.empty())
    return fail(ErrorKind::device, "the device reports no sampling rate or no channel", uri,
                "check its firmware");
  for (const wire::Channel& said : description.channels) {
    auto channel = channel_of(said, uri);
    TACTO_TRY(channel);
    capabilities.channels.push_back(std::move(*channel));
  }
  if (const std::string name = note_of(description, wire::NoteKind::transducer); !name.empty()) {
    auto transducer = schema::read_transducer(name);
    TACTO_TRY(transducer);
    capabilities.transducer = std::move(*transducer);
    capabilities.transducer_file = name;
  }
  capabilities.uri = std::move(uri);
  capabilities.name = description.welcome.name;
  capabilities.serial = description.welcome.serial;
  capabilities.firmware = description.welcome.firmware;
  capabilities.simulated = simulated_samples(description);
  capabilities.simulated_device = simulated_device(description);
  capabilities.surface = note_of(description, wire::NoteKind::surface);
  capabilities.clock = "device";
  return capabilities;
}

}  // namespace tacto::firmware_host
