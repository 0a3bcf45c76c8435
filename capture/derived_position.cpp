// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/derived_position.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "data-schema/quantity.hpp"

namespace tacto::capture {
namespace {

schema::Channel position_channel(std::string derivation) {
  schema::Channel channel;
  channel.name = channel.quantity = "position";
  channel.unit = "m";
  channel.derivation = std::move(derivation);
  return channel;
}

// Each frame's number in the clock's count, missing ones included: exact, where a sum of periods would drift.
std::vector<double> ticks_of(const schema::RecordingHeader& header) {
  std::vector<double> ticks(header.frames);
  auto gap = header.gaps.begin();
  std::uint64_t missing = 0;
  for (std::uint64_t frame = 0; frame < header.frames; ++frame) {
    for (; gap != header.gaps.end() && gap->frame <= frame; ++gap) missing += gap->count;
    ticks[frame] = static_cast<double>(frame + missing);
  }
  return ticks;
}

}  // namespace

DerivedChannel nominal_position(const schema::RecordingHeader& header, double speed_mps) {
  const std::string speed = schema::for_people(speed_mps, schema::Dimension::speed);
  DerivedChannel derived{position_channel("nominal: " + speed), ticks_of(header)};
  for (double& value : derived.values) value = value / header.sample_rate_hz * speed_mps;
  return derived;
}

DerivedChannel integrated_position(const schema::RecordingHeader& header, const schema::Channel& speed,
                                   std::span<const double> stored) {
  DerivedChannel derived{position_channel(fmt::format("integrated from {} (trapezoid rule)", speed.name)),
                         ticks_of(header)};
  const auto speed_mps = [&](std::size_t i) { return stored[i] * speed.scale + speed.offset; };
  double position_m = 0;
  double last_tick = 0;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const double step_s = (derived.values[i] - last_tick) / header.sample_rate_hz;
    if (i > 0) position_m += (speed_mps(i - 1) + speed_mps(i)) / 2 * step_s;
    last_tick = derived.values[i];
    derived.values[i] = position_m;
  }
  return derived;
}

}  // namespace tacto::capture
