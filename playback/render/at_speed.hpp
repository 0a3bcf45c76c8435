// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a transducer can play a texture under a finger of an even speed.
#pragma once

#include <optional>

#include "playback/render/render.hpp"

namespace tacto::playback {

/// Least share of a texture's power that has to be in the band, in percent; our choice.
inline constexpr double kLeastPowerPercent = 90;

/// Peaks are those of the drive that the target needs, without limits.
struct AtSpeed {
  double speed_mps = 0;
  Peak tightest;                  ///< the peak that uses most of its limit
  double power_kept_percent = 0;  ///< share of the texture's power in the band (spatial::band_kept_percent)

  bool fits_limits() const { return tightest.used() <= 1; }
  bool can_be_played() const;
};

/// Along the whole texture at that speed, by the exact reference (render()). It can be played if no limit of
/// the transducer is passed and at least kLeastPowerPercent of the texture's power is in options.band.
/// Errors: as render().
schema::Result<AtSpeed> at_speed(const schema::Texture& texture, const schema::Transducer& transducer,
                                 const RenderOptions& options, double speed_mps);

/// The largest speed, to 1 %, at which it can be played, from 1 mm/s to 2 m/s; none: at no speed. Tries
/// speeds a quarter of an octave apart from the largest on, then divides. Speeds that render() refuses,
/// because the texture is too short for them, cannot be played.
std::optional<double> largest_speed_mps(const schema::Texture& texture, const schema::Transducer& transducer,
                                        const RenderOptions& options);

}  // namespace tacto::playback
