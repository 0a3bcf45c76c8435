// SPDX-License-Identifier: GPL-3.0-or-later
// One way to play a texture under fingers of several speeds.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "analysis/trade/rows/played_case.hpp"
#include "analysis/trade/rows/trade_row.hpp"

namespace tacto::analysis {

/// A slow finger, a usual one and a fast one: a delay is a way that grows with speed, the edges of a count
/// come rarer without it.
inline constexpr std::array<double, 3> kTradeSpeeds_mps = {0.025, 0.1, 0.2};

/// The outcomes, one a speed.
class PlayedSpeeds {
 public:
  /// Plays `played` once for each speed. Errors: of play_case.
  static schema::Result<PlayedSpeeds> of(const schema::Texture& texture, const schema::Transducer& transducer,
                                         PlayedCase played,
                                         std::span<const double> speeds_mps = kTradeSpeeds_mps);

  /// One kind of error by speed; NaN where less than a twentieth of the texture (RMS) lies in the band.
  std::vector<ErrorAtSpeed> errors(double PlayedOutcome::*kind = &PlayedOutcome::error) const;

  /// What ticks are clocked by, and what does not change with the speed: of the middle one.
  const PlayedOutcome& middle() const { return outcomes_[outcomes_.size() / 2]; }

 private:
  std::vector<double> speeds_mps_;
  std::vector<PlayedOutcome> outcomes_;
};

/// The largest; NaN where there is none.
double worst_of(std::span<const ErrorAtSpeed> errors);

/// "25, 100, 200 mm/s".
std::string speed_words(std::span<const ErrorAtSpeed> errors);

}  // namespace tacto::analysis
