// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/choose/unsteady_speed.hpp"

#include <algorithm>
#include <numbers>

#include "playback/model/spatial_content.hpp"

namespace tacto::playback {
namespace {

double speed_lag_s(double rate_hz) {
  const double alpha = std::min(double{core::kMostAlpha}, 1 / (1 + kTrackerS * rate_hz));
  const double beta = alpha * alpha / (2 - alpha);
  return (alpha - beta / 2) / beta / rate_hz;
}

}  // namespace

double missed_place_m(const UnsteadySpeed& hand, const PrepareOptions& options, double delay_s) {
  const double acceleration =
      std::numbers::sqrt2 * std::numbers::pi * hand.rate_hz * hand.part * hand.speed_mps;
  const double ahead_s = delay_s + options.loop_delay_s;
  if (!options.look_ahead) return hand.speed_mps * ahead_s;
  return acceleration * ahead_s * (ahead_s / 2 + speed_lag_s(options.rate_hz));
}

double unsteady_speed_error(std::span<const PlacedTexture> textures, const UnsteadySpeed& hand,
                            const PrepareOptions& options, double delay_s) {
  double steepest = 0;
  for (const PlacedTexture& placed : textures)
    steepest = std::max(steepest, relative_slope(placed.texture->signal, options.band.low_hz / hand.speed_mps,
                                                 options.band.high_hz / hand.speed_mps));
  return steepest * missed_place_m(hand, options, delay_s);
}

}  // namespace tacto::playback
