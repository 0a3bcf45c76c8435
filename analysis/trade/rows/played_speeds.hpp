// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a texture in one way under fingers of several speeds, and measures the errors.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "analysis/trade/rows/played_case.hpp"
#include "analysis/trade/rows/trade_row.hpp"

namespace tacto::analysis {

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
