// SPDX-License-Identifier: GPL-3.0-or-later
// Measures one way to play a texture: its error against the exact reference, and the cost of a tick.
#pragma once

#include <functional>

#include "data-schema/base/error.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::analysis {

/// The motion of the finger on a loop of the texture.
struct FingerMotion {
  double speed_mps = 0.1;
  bool wanders = false;  ///< by 10 % of the speed (RMS), below 2 Hz
};

/// The part of the chain from force to tray that is measured.
enum class PlayedPart { whole, reading };

struct PlayedCase {
  playback::PrepareOptions options;  ///< ends, origin and gain are set by play_case
  FingerMotion way;
  PlayedPart part = PlayedPart::whole;
  bool in_double = false;  ///< uses the kernel in double precision
};

struct PlayedOutcome {
  double error = 0;            ///< RMS over the band of the error of tray (or force), re the target's RMS
  double later_error = 0;      ///< the same against the target delayed by delay_left_s
  double amplitude_error = 0;  ///< error of the spectrum's magnitudes, without phases
  double target_part = 0;  ///< RMS of the target displacement in the band, re that of the texture times gain
  std::function<void()> ticking;  ///< runs the ticks again, for timing
  double ticks = 0;
  double memory_bytes = 0;
  double delay_left_s = 0;
  std::vector<float> drive_v;
};

/// An encoder so fine that its count is practically the finger's exact position.
inline constexpr double kTrueEncoderM = 1e-9;

/// Plays 0.8 s of a looped texture through the modelled transducer (with its hysteresis) and compares with
/// the exact reference, without 0.15 s at both ends. The target displacement peaks at a fiftieth of the
/// transducer's limit, so that no limit is reached. Errors: those of prepare().
schema::Result<PlayedOutcome> play_case(const schema::Texture& texture, const schema::Transducer& transducer,
                                        const PlayedCase& played);

}  // namespace tacto::analysis
