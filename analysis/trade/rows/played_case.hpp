// SPDX-License-Identifier: GPL-3.0-or-later
// One way to play a texture, measured: what it errs against the exact reference, and what a tick costs.
#pragma once

#include <functional>

#include "data-schema/base/error.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::analysis {

/// The finger's way meanwhile, on a loop of the texture.
struct FingerWay {
  double speed_mps = 0.1;
  bool wanders = false;  ///< by 10 % of the speed (RMS), below 2 Hz
};

/// What of the way from force to tray is looked at.
enum class PlayedPart { whole, reading };

struct PlayedCase {
  playback::PrepareOptions options;  ///< ends, origin and gain are filled in
  FingerWay way;
  PlayedPart part = PlayedPart::whole;
  bool in_double = false;  ///< by the kernel in double precision
};

struct PlayedOutcome {
  double error = 0;            ///< RMS over the band of tray (or force) off, re the wanted one's RMS
  double later_error = 0;      ///< the same re what was wanted delay_left_s before
  double amplitude_error = 0;  ///< of the spectrum's magnitudes alone, whatever their phases
  double target_part = 0;      ///< RMS of the wanted displacement over the band, re the texture's times gain
  std::function<void()> ticking;  ///< the ticks again, for a clock
  double ticks = 0;
  double memory_bytes = 0;
  double delay_left_s = 0;
  std::vector<float> drive_v;
};

/// An encoder whose count is as good as the finger's own place.
inline constexpr double kTrueEncoderM = 1e-9;

/// 0.8 s of a looped texture through the modelled transducer (its hysteresis, too) against the exact
/// reference, 0.15 s at either end left out. The wanted displacement peaks at a fiftieth of the transducer's
/// limit: no limit is met. Errors: as prepare().
schema::Result<PlayedOutcome> play_case(const schema::Texture& texture, const schema::Transducer& transducer,
                                        const PlayedCase& played);

}  // namespace tacto::analysis
