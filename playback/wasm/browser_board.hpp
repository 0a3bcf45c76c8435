// SPDX-License-Identifier: GPL-3.0-or-later
// Constants of the emulated device that the page of `tactograph live` runs, the same in the page and in the
// server.
#pragma once

#include "firmware-host/core/firmware/board.hpp"

namespace tacto::browser {

inline constexpr uint32_t kRateHz =
    16000;  ///< of a tray's ticks: a third of 48 kHz, so that sound needs no resampling
inline constexpr uint32_t kClocksPerTick = 1000;
inline constexpr double kMetresPerCount = 1e-6;  ///< of its encoder
inline constexpr uint32_t kProfileSamples =
    1U << 22;  ///< 16 MB: a metre of texture on a 1 um grid, with all levels
inline constexpr float kDriveLimitV = 1e4F,
                       kSlewLimitVPerS = 1e9F;  ///< no amplifier: the transducer's file has the limits

/// Its only channel.
inline wire::Channel encoder_channel() noexcept {
  wire::Channel channel;
  constexpr char kName[] = "encoder", kQuantity[] = "position", kUnit[] = "m";
  for (size_t i = 0; i < sizeof kName; ++i) channel.name[i] = kName[i];
  for (size_t i = 0; i < sizeof kQuantity; ++i) channel.quantity[i] = kQuantity[i];
  for (size_t i = 0; i < sizeof kUnit; ++i) channel.unit[i] = kUnit[i];
  channel.scale = kMetresPerCount;
  channel.native_rate_hz = __builtin_nan("");
  return channel;
}

/// A tray, or with `axes` a force device. `channel` (encoder_channel()), `profile` (kProfileSamples) and
/// `axes` must outlive the firmware.
inline core::Board board(const wire::Channel& channel, float* profile, const wire::Axes* axes = nullptr,
                         uint32_t rate_hz = kRateHz) noexcept {
  core::Board board;
  board.channels = &channel;
  board.channel_count = 1;
  board.profile_memory = profile;
  board.profile_samples = kProfileSamples;
  board.axes = axes;
  wire::Welcome& about = board.about;
  constexpr char kName[] = "browser", kFirmware[] = "core";
  for (size_t i = 0; i < sizeof kName; ++i) about.name[i] = kName[i];
  for (size_t i = 0; i < sizeof kFirmware; ++i) about.firmware[i] = kFirmware[i];
  about.features = wire::kFeatureSimulated | (axes == nullptr ? wire::kFeatureDrive : 0U);
  about.clock_hz = kClocksPerTick * rate_hz;
  about.default_rate_millihertz = about.least_rate_millihertz = about.most_rate_millihertz = 1000 * rate_hz;
  about.drive_limit_v = kDriveLimitV;
  about.slew_limit_v_per_s = kSlewLimitVPerS;
  return board;
}

}  // namespace tacto::browser
