// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/upload.hpp"

#include <fmt/format.h>

#include "firmware-host/wire_fields.hpp"

namespace tacto::playback {
namespace {

using schema::fail;
using schema::Fault;

constexpr std::uint8_t kTexturesSinceMinor = 1;

}  // namespace

schema::Result<void> check_fits(const Prepared& prepared, const wire::Welcome& device,
                                const std::string& uri) {
  if (device.minor < kTexturesSinceMinor)
    return fail(Fault::unsupported_version,
                fmt::format("the device speaks version {}.{} of the protocol; textures came with 1.{}",
                            device.major, device.minor, kTexturesSinceMinor),
                uri, "update the device's firmware");
  if (prepared.samples.size() > device.profile_samples)
    return fail(Fault::unsuitable,
                fmt::format("the texture takes {} samples, the device holds {}", prepared.samples.size(),
                            device.profile_samples),
                uri, "play a shorter one, or close the loop on the host");
  const std::uint32_t rate = firmware_host::millihertz(prepared.rate_hz);
  if (rate >= device.least_rate_millihertz && rate <= device.most_rate_millihertz) return {};
  return fail(Fault::unsuitable,
              fmt::format("the device ticks at {:g} to {:g} Hz", 1e-3 * device.least_rate_millihertz,
                          1e-3 * device.most_rate_millihertz),
              uri, "ask for a rate between them");
}

wire::Limits limits_for(const Prepared& prepared, const wire::Welcome& device) {
  wire::Limits limits = prepared.limits;
  limits.drive_v = std::min(limits.drive_v, device.drive_limit_v);
  limits.slew_v_per_s = std::min(limits.slew_v_per_s, device.slew_limit_v_per_s);
  return limits;
}

wire::Texture texture_message(const Prepared& prepared) {
  wire::Texture texture;
  texture.levels = prepared.scale.levels;
  texture.interpolation = prepared.scale.interpolation;
  texture.between_counts = prepared.tracker.between_counts ? 1 : 0;
  texture.look_ahead_ticks = prepared.tracker.look_ahead_ticks;
  texture.smoothing_ticks = std::max(1.0F, prepared.tracker.smoothing_ticks);
  texture.full_detail_counts_per_tick = prepared.full_detail_counts_per_tick;
  texture.energy_rms_v = prepared.energy_rms_v;
  texture.energy_window_s = prepared.energy_window_s;
  return texture;
}

wire::Taps taps_message(const Prepared& prepared) {
  wire::Taps taps;
  taps.count = static_cast<std::uint8_t>(std::min(prepared.taps.size(), wire::kMaxTaps));
  std::copy_n(prepared.taps.begin(), taps.count, taps.taps);
  return taps;
}

wire::ProfileBegin begin_message(const Prepared& prepared) {
  return {prepared.scale.samples, prepared.scale.origin_count, prepared.scale.at_origin_q32,
          prepared.scale.samples_per_count_q32, prepared.scale.ends};
}

wire::Arm arm_message(const Prepared& prepared) {
  return {wire::DriveSource::profile, firmware_host::millihertz(prepared.rate_hz)};
}

std::uint32_t check_of(std::span<const float> samples) {
  std::uint32_t check = 0;
  for (const float sample : samples) {
    std::uint8_t bytes[sizeof sample];
    wire::FieldWriter(bytes, sizeof bytes)(sample);
    check = wire::crc32c(bytes, sizeof bytes, check);
  }
  return check;
}

}  // namespace tacto::playback
