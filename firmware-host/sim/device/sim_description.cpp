// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_description.hpp"

#include <fmt/format.h>

#include <limits>

#include "data-schema/base/quantity.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/link/wire_fields.hpp"
#include "firmware-host/sim/device/tray_sensor.hpp"

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

std::string finger_words(const SimParameters& p) {
  if (!p.finger_down) return "finger up";
  return fmt::format(
      "finger of person {} (elastic ridges, LuGre friction, mass-spring-damper pulp) at {} and {}", p.person,
      for_people(p.strokes.speed_mps, Dimension::speed), for_people(p.load_n, Dimension::force));
}

std::string force_words(const ForcePlan& force) {
  const auto hz = [](double value) { return for_people(value, Dimension::frequency); };
  const std::string size = for_people(force.amplitude_n, Dimension::force);
  if (force.shape == ForceShape::sine)
    return fmt::format("known force, a sine of {} at {}", size, hz(force.low_hz));
  if (force.shape == ForceShape::release)
    return fmt::format("a weight of {} on a thread that is cut after {}", size,
                       for_people(force.sweep_s, Dimension::time));
  const std::string band = fmt::format("{} to {}", hz(force.low_hz), hz(force.high_hz));
  if (force.shape == ForceShape::chirp)
    return fmt::format("known force, a chirp of {}, {} in {}", size, band,
                       for_people(force.sweep_s, Dimension::time));
  return fmt::format("known force, {} tones of {}, {}", force.tones, size, band);
}

std::string extras_words(const SimParameters& p) {
  std::string words;
  if (p.has_lvdt)
    words += fmt::format(", position by an LVDT of {}", for_people(p.lvdt.range_m, Dimension::length));
  if (p.has_second_mode)
    words += fmt::format(", second mode at {}", for_people(p.second_mode.frequency_hz, Dimension::frequency));
  if (p.hysteresis > 0) words += fmt::format(", driven with {:g} % of hysteresis", 100 * p.hysteresis);
  if (p.has_reconstruction)
    words += fmt::format(", driven through a Butterworth low-pass of order 3 at {}",
                         for_people(p.reconstruction_cutoff_hz, Dimension::frequency));
  if (p.has_finger_load) words += ", driven under a resting finger's load";
  return words;
}

std::string simulated_by(const SimParameters& p) {
  return fmt::format("by {}'s emulated device{}, seed {}{}", kCreator, p.counter ? "" : extras_words(p),
                     p.seed,
                     p.surface.seed == p.seed ? "" : fmt::format(", surface seed {}", p.surface.seed));
}

// The content of its recorded frames. During playback the surface is not used: the finger is on the texture.
std::string recorded_words(const SimParameters& p, std::string_view surface) {
  if (p.counter) return "frames that contain their numbers, no physics";
  return p.known_force ? force_words(p.force) : fmt::format("{}, on {}", finger_words(p), surface);
}

wire::Channel position_channel(const SimRun& run, const SimParameters& p) {
  if (run.lvdt() == nullptr)
    return channel_of("position", "m", p.encoder_quantum_m, "encoder on the finger, plain counts");
  wire::Channel channel = converted("position", "m", run.lvdt()->converter(), "LVDT on the finger");
  channel.offset = run.lvdt()->centre_m();
  channel.range_min += channel.offset;
  channel.range_max += channel.offset;
  return channel;
}

}  // namespace

std::vector<wire::Channel> sim_channels(const SimRun& run, const SimParameters& parameters) {
  std::vector<wire::Channel> channels = {
      converted("tangential_force", "V", run.converter(), "transducer, piezo sensor"),
      position_channel(run, parameters), load_channel("normal_force", run.normal_cell()),
      load_channel("net_force", run.net_cell())};
  if (run.reference_cell() != nullptr) {
    channels.push_back(
        converted("applied_force", "N", *run.reference_cell(), "reference cell in line with the pull"));
    put_text(channels.back().quantity, "net_force");
  }
  if (parameters.watches_tray())
    channels.push_back(
        converted("displacement", "m", TraySensor(parameters).converter(), "vibrometer on the driven tray"));
  return numbered(std::move(channels));
}

std::vector<wire::Channel> counter_channels(int count) {
  std::vector<wire::Channel> channels;
  for (int i = 0; i < count; ++i) {
    channels.push_back(channel_of("signal", "1", 1, "counter: 16 x frame + channel"));
    put_text(channels.back().name, fmt::format("signal_{}", i));
  }
  return numbered(std::move(channels));
}

std::vector<wire::Note> sim_notes(const SimParameters& parameters, std::string_view surface) {
  const bool touched = !parameters.counter && !parameters.known_force;
  return numbered<wire::Note>(
      {note_of(wire::NoteKind::simulated_by, simulated_by(parameters)),
       note_of(wire::NoteKind::simulated_by, recorded_words(parameters, surface)),
       note_of(wire::NoteKind::transducer, parameters.counter ? std::string() : parameters.transducer),
       note_of(wire::NoteKind::surface, touched ? surface : std::string_view())});
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
