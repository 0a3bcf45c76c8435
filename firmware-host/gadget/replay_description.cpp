// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/replay_description.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "data-schema/version.hpp"
#include "firmware-host/link/wire_fields.hpp"

namespace tacto::firmware_host {
namespace {

double or_none(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

wire::Channel channel_of(const schema::Channel& stored) {
  wire::Channel channel;
  put_text(channel.name, stored.name);
  put_text(channel.quantity, stored.quantity);
  put_text(channel.unit, stored.unit);
  put_text(channel.source, stored.source);
  put_text(channel.calibrated, stored.calibrated);
  channel.scale = stored.scale;
  channel.offset = stored.offset;
  channel.range_min = or_none(stored.range_min);
  channel.range_max = or_none(stored.range_max);
  channel.native_rate_hz = or_none(stored.native_rate_hz);
  return channel;
}

std::string name_of(const schema::Recording& recording) {
  return "replay of " + std::filesystem::path(recording.stem).filename().string();
}

// The host finds a transducer by its name, so only a transducer with a known name is reported.
bool is_preset(const schema::Transducer& transducer) {
  return schema::read_transducer(transducer.name).has_value();
}

}  // namespace

wire::Welcome replay_welcome(const schema::Recording& recording, const std::string& serial) {
  wire::Welcome welcome;
  put_text(welcome.name, name_of(recording));
  put_text(welcome.serial, serial.empty() ? "replay" : serial);
  put_text(welcome.firmware, kCreator);
  welcome.features = wire::kFeatureSimulated;
  if (const auto& transducer = recording.header.transducer) {
    welcome.features |= wire::kFeatureDrive;
    welcome.drive_limit_v = not_above(transducer->drive_limit_v);
    welcome.slew_limit_v_per_s = not_above(transducer->slew_limit_v_per_s);
  }
  return welcome;
}

std::vector<wire::Channel> replay_channels(const schema::RecordingHeader& header) {
  std::vector<wire::Channel> channels;
  for (const schema::Channel& stored : header.channels) channels.push_back(channel_of(stored));
  return numbered(std::move(channels));
}

std::vector<wire::Note> replay_notes(const schema::Recording& recording) {
  const schema::RecordingHeader& header = recording.header;
  std::vector<wire::Note> notes{
      note_of(wire::NoteKind::simulated_by, fmt::format("by {}'s {}", kCreator, name_of(recording)))};
  if (!header.simulated.empty())
    notes.push_back(note_of(wire::NoteKind::simulated_by, "itself simulated " + header.simulated));
  if (header.transducer && is_preset(*header.transducer))
    notes.push_back(note_of(wire::NoteKind::transducer, header.transducer->name));
  if (!header.surface.empty()) notes.push_back(note_of(wire::NoteKind::surface, header.surface));
  return numbered(std::move(notes));
}

}  // namespace tacto::firmware_host
