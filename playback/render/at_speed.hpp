// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether a transducer can play a texture under a finger of constant speed.
#pragma once

#include <optional>

#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "playback/model/limits.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// Least share of a texture's power that has to be in the band, in percent; our choice.
inline constexpr double kLeastPowerPercent = 90;

struct AtSpeed {
  double speed_mps = 0;
  Peak tightest;                  ///< of the unlimited drive: the peak that uses most of its limit
  double power_kept_percent = 0;  ///< share of the texture's power in the band (spatial::band_kept_percent)

  bool fits_limits() const { return tightest.used() <= 1; }
  bool keeps_power() const { return power_kept_percent >= kLeastPowerPercent; }
  bool can_be_played() const { return fits_limits() && keeps_power(); }
};

struct SpeedRange {
  double from_mps = 0, to_mps = 0;
};

/// One texture as it was prepared for a device. `options` are those of prepare().
struct PreparedTexture {
  const schema::Texture& texture;
  const schema::Transducer& transducer;
  const Prepared& prepared;
  const PrepareOptions& options;
};

/// Along the whole texture at that speed, by the kernel as the device runs it, without limits. It can be
/// played if no limit of the transducer is passed and at least kLeastPowerPercent of the texture's power is
/// in the band. Precondition: speed above 0.
AtSpeed at_speed(const PreparedTexture& played, double gain_m_per_n, double speed_mps);

/// The largest gain, with the sign of `gain_m_per_n`, at which no limit is passed at that speed; 0: none.
double largest_gain_at(const PreparedTexture& played, double gain_m_per_n, double speed_mps);

/// The largest range of speeds, to 0.1 %, at which it can be played, within 1 mm/s to 2 m/s; the one
/// around `near_mps` if it can be played there, else the fastest. None: at no speed. Tries speeds a quarter
/// of an octave apart, then divides.
std::optional<SpeedRange> playable_speeds(const PreparedTexture& played, double gain_m_per_n,
                                          double near_mps);

}  // namespace tacto::playback
