// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/upload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware-host/core/wire/crc32c.hpp"

namespace tacto::playback {

using firmware_host::Client;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

Result<void> check_room(const Client& client, const Prepared& prepared) {
  const wire::Welcome& device = client.description().welcome;
  if ((device.features & wire::kFeatureTextures) == 0)
    return fail(ErrorKind::device,
                fmt::format("'{}' (firmware {}) can't play textures itself: its protocol is {}.{}",
                            device.name, device.firmware, device.major, device.minor),
                client.where(),
                "update its firmware, or close the loop on the host (--loop host; \"loop\": \"host\" in the "
                "daemon's configuration)");
  if (prepared.samples.size() > device.profile_samples)
    return fail(ErrorKind::unsuitable,
                fmt::format("the texture needs {} samples, '{}' holds {}", prepared.samples.size(),
                            device.name, device.profile_samples),
                client.where(), ways_to_fit(prepared.scale.interpolation));
  return check_rate(client, prepared.rate_hz);
}

std::uint32_t check_with(std::span<const float> samples, std::uint32_t check) {
  for (const float sample : samples) {
    std::uint8_t bytes[4];
    wire::FieldWriter(bytes, sizeof bytes)(sample);
    check = wire::crc32c(bytes, sizeof bytes, check);
  }
  return check;
}

Result<void> send_samples(Client& client, const Prepared& prepared, double times) {
  wire::ProfileChunk chunk{};
  std::uint32_t check = 0;
  for (std::size_t first = 0; first < prepared.samples.size(); first += wire::kMaxChunk) {
    const std::size_t count = std::min(wire::kMaxChunk, prepared.samples.size() - first);
    chunk.first = static_cast<std::uint32_t>(first);
    chunk.count = static_cast<std::uint16_t>(count);
    std::ranges::transform(std::span(prepared.samples).subspan(first, count), chunk.values,
                           [=](float sample) { return static_cast<float>(times * sample); });
    check = check_with(std::span(chunk.values, count), check);
    if (auto sent = client.command(chunk); !sent) return sent;
  }
  return client.command(wire::ProfileEnd{check});
}

Result<void> send_levels(Client& client, const Prepared& prepared, double times) {
  const core::ProfileScale& scale = prepared.scale;
  const auto all = static_cast<std::uint32_t>(prepared.samples.size());
  const wire::ProfileBegin begin{all, scale.origin_count, scale.at_origin_q32, scale.samples_per_count_q32,
                                 scale.ends};
  if (auto sent = client.command(begin); !sent) return sent;
  if (auto sent = client.command(wire::ProfileLevels{scale.levels, scale.interpolation, 0, scale.samples});
      !sent)
    return sent;
  return send_samples(client, prepared, times);
}

Result<void> send_filters(Client& client, const Prepared& prepared) {
  wire::Taps taps{};
  taps.count = static_cast<std::uint16_t>(prepared.taps.size());
  std::ranges::copy(prepared.taps, taps.taps);
  if (auto sent = client.command(taps); !sent) return sent;
  wire::Filters filters{};
  filters.count = static_cast<std::uint8_t>(prepared.sections.size());
  std::ranges::copy(prepared.sections, filters.sections);
  return client.command(filters);
}

// Fails only if the playback needs the inverse of a hysteresis and the device's firmware does not have it.
Result<void> check_hysteresis(const Client& client, const Prepared& prepared) {
  const wire::Welcome& device = client.description().welcome;
  if (prepared.play_operators.count == 0 || (device.features & wire::kFeatureHysteresis) != 0) return {};
  return fail(ErrorKind::device,
              fmt::format("'{}' (firmware {}) does not invert hysteresis", device.name, device.firmware),
              client.where(), "update its firmware, or play without (--keep-hysteresis)");
}

Result<void> check_contact(const Client& client, const Prepared& prepared) {
  if (!(prepared.gate_on_n > 0) || force_channel(client) != nullptr) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("'{}' reports no normal force, which the contact gate needs",
                          client.description().welcome.name),
              client.where(), "play without (--contact 0N; \"contact_on_n\": 0 in playback)");
}

Result<void> send_hysteresis(Client& client, const Prepared& prepared) {
  if (prepared.play_operators.count == 0) return {};
  return client.command(prepared.play_operators);
}

Result<void> send_tracking(Client& client, const Prepared& prepared) {
  const core::TrackerSetup& tracker = prepared.tracker;
  return client.command(wire::Tracking{tracker.between_counts,
                                       {},
                                       tracker.look_ahead_ticks,
                                       tracker.smoothing_ticks,
                                       prepared.full_detail_counts_per_tick});
}

Result<void> send_contact(Client& client, const Prepared& prepared) {
  if (!(prepared.gate_on_n > 0)) return {};
  const wire::Channel& force = *force_channel(client);
  return client.command(wire::Contact{force.index,
                                      {},
                                      prepared.gate_on_n,
                                      prepared.gate_off_n,
                                      static_cast<float>(force.scale),
                                      static_cast<float>(force.offset)});
}

}  // namespace

const wire::Channel* force_channel(const Client& client) {
  const auto& channels = client.description().channels;
  const auto force = std::ranges::find_if(channels, [](const wire::Channel& c) {
    return std::string_view(c.quantity) == "normal_force" && std::string_view(c.unit) == "N";
  });
  return force == channels.end() ? nullptr : &*force;
}

Result<void> check_rate(const Client& client, double rate_hz) {
  const wire::Welcome& device = client.description().welcome;
  const double rate_millihertz = 1e3 * rate_hz;
  if (rate_millihertz >= device.least_rate_millihertz && rate_millihertz <= device.most_rate_millihertz)
    return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("'{}' supports {:g} to {:g} ticks per second, not {:g}", device.name,
                          1e-3 * device.least_rate_millihertz, 1e-3 * device.most_rate_millihertz, rate_hz),
              client.where(), "choose a rate in this range");
}

Result<void> check_upload(const Client& client, const Prepared& prepared) {
  if (auto room = check_room(client, prepared); !room) return room;
  if (auto knows = check_hysteresis(client, prepared); !knows) return knows;
  return check_contact(client, prepared);
}

Result<void> upload(Client& client, const Prepared& prepared) {
  if (auto fits = check_upload(client, prepared); !fits) return fits;
  if (auto sent = client.command(prepared.limits); !sent) return sent;
  if (auto sent = send_levels(client, prepared, 1); !sent) return sent;
  if (auto sent = send_filters(client, prepared); !sent) return sent;
  if (auto sent = send_hysteresis(client, prepared); !sent) return sent;
  if (auto sent = send_tracking(client, prepared); !sent) return sent;
  if (auto sent = client.command(wire::Energy{prepared.energy_rms_v, prepared.energy_window_s}); !sent)
    return sent;
  if (auto sent = send_contact(client, prepared); !sent) return sent;
  return client.command(wire::Gain{prepared.gain_m_per_n});
}

Result<void> upload_next(Client& client, const Prepared& prepared, double device_gain_m_per_n) {
  const double times = prepared.gain_m_per_n / device_gain_m_per_n;
  if (!std::isfinite(times))
    return fail(ErrorKind::unsuitable, "plays with a gain of 0, to which no texture can be scaled",
                client.where(), "disarm, and load it again");
  if (auto sent = send_levels(client, prepared, times); !sent) return sent;
  return send_tracking(client, prepared);
}

Result<void> upload_change(Client& client, const Prepared& prepared, double device_gain_m_per_n,
                           double fade_s) {
  if (auto sent = upload_next(client, prepared, device_gain_m_per_n); !sent) return sent;
  return client.command(wire::Change{static_cast<float>(fade_s)});
}

}  // namespace tacto::playback
