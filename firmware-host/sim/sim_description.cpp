// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/sim_description.hpp"

#include <fmt/format.h>

#include <limits>

#include "data-schema/quantity.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/wire_fields.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Dimension;
using schema::for_people;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

wire::Channel channel_of(std::string_view name, std::string_view unit, double scale,
                         std::string_view source) {
  wire::Channel channel;
  put_text(channel.name, name);
  put_text(channel.quantity, name);
  put_text(channel.unit, unit);
  put_text(channel.source, source);
  channel.scale = scale;
  channel.range_min = channel.range_max = channel.native_rate_hz = kNone;
  return channel;
}

wire::Channel converted(std::string_view name, std::string_view unit, const Converter& converter,
                        std::string_view source) {
  wire::Channel channel = channel_of(name, unit, converter.scale(), source);
  channel.range_min = converter.least();
  channel.range_max = converter.most();
  return channel;
}

wire::Channel load_channel(std::string_view name, const LoadCell& cell) {
  wire::Channel channel = converted(name, "N", cell.converter(), "load cell under the transducer");
  channel.native_rate_hz = cell.native_rate_hz();
  return channel;
}

wire::Note note_of(wire::NoteKind kind, std::string_view text) {
  wire::Note note;
  note.kind = kind;
  put_text(note.text, text);
  return note;
}

std::string simulated_by(const SimParameters& p, std::string_view surface) {
  const std::string finger =
      p.finger_down
          ? fmt::format(
                "finger of person {} (elastic ridges, LuGre friction, mass-spring-damper pulp) at {} and {}",
                p.person, for_people(p.strokes.speed_mps, Dimension::speed),
                for_people(p.load_n, Dimension::force))
          : std::string("finger up");
  return fmt::format("by {}'s emulated device: {}, on {}, seed {}", kCreator, finger, surface, p.seed);
}

}  // namespace

std::vector<wire::Channel> sim_channels(const SimRun& run, const SimParameters& parameters) {
  return numbered<wire::Channel>(
      {converted("tangential_force", "V", run.converter(), "transducer, piezo sensor"),
       channel_of("position", "m", parameters.encoder_quantum_m, "encoder on the finger, plain counts"),
       load_channel("normal_force", run.normal_cell()), load_channel("net_force", run.net_cell())});
}

std::vector<wire::Note> sim_notes(const SimParameters& parameters, std::string_view surface) {
  return numbered<wire::Note>({note_of(wire::NoteKind::simulated_by, simulated_by(parameters, surface)),
                               note_of(wire::NoteKind::transducer, parameters.transducer),
                               note_of(wire::NoteKind::surface, surface)});
}

wire::Welcome sim_welcome(const SimParameters& parameters, const schema::Transducer& transducer) {
  wire::Welcome welcome;
  put_text(welcome.name, "emulated transducer");
  put_text(welcome.serial,
           parameters.serial.empty() ? fmt::format("sim-{}", parameters.seed) : parameters.serial);
  put_text(welcome.firmware, kCreator);
  welcome.features = wire::kFeatureSimulated | wire::kFeatureDrive | wire::kFeatureEnableInput;
  welcome.drive_limit_v = not_above(transducer.drive_limit_v);
  welcome.slew_limit_v_per_s = not_above(transducer.slew_limit_v_per_s);
  return welcome;
}

}  // namespace tacto::firmware_host
