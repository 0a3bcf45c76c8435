// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a texture in one way under fingers of several speeds, and measures the errors.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::analysis {

// Measures one way to play a texture: its error against the exact reference, and the cost of a tick.

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

/// A slow, a usual and a fast finger: with the speed, a delay becomes a longer distance; with a slow finger,
/// edges of the count are rarer.
inline constexpr std::array<double, 3> kTradeSpeeds_mps = {0.025, 0.1, 0.2};

/// The outcomes, one per speed.
class PlayedSpeeds {
 public:
  /// Plays `played` once for each speed. Errors: those of play_case.
  static schema::Result<PlayedSpeeds> of(const schema::Texture& texture, const schema::Transducer& transducer,
                                         PlayedCase played,
                                         std::span<const double> speeds_mps = kTradeSpeeds_mps);

  /// One kind of error by speed; NaN if less than a twentieth of the texture (RMS) is in the band.
  std::vector<ErrorAtSpeed> errors(double PlayedOutcome::*kind = &PlayedOutcome::error) const;

  /// The outcome of the middle speed, for timing and for values that do not change with the speed.
  const PlayedOutcome& middle() const { return outcomes_[outcomes_.size() / 2]; }

 private:
  std::vector<double> speeds_mps_;
  std::vector<PlayedOutcome> outcomes_;
};

/// The largest; NaN if there is none.
double worst_of(std::span<const ErrorAtSpeed> errors);

/// "25, 100, 200 mm/s".
std::string speed_words(std::span<const ErrorAtSpeed> errors);

}  // namespace tacto::analysis
