// SPDX-License-Identifier: GPL-3.0-or-later
// What a hand costs that does not go evenly.
#pragma once

#include <span>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// Its speed swings about a mean: v (1 + part sin(2 pi rate t)).
struct WanderingHand {
  double speed_mps = 0.05;
  double part = 0.1;
  double rate_hz = 2;
};

/// How far looking ahead misses the place, RMS, m: a delay d ahead, a steady acceleration a is missed by a d
/// (d / 2 + t), t by which the tracker's speed lags (that of an alpha-beta filter: (alpha - beta / 2) / beta
/// ticks; core FingerTracker). For swings that are slow to both.
double missed_place_m(const WanderingHand& hand, const PrepareOptions& options, double delay_s);

/// RMS error of what is read there, re what lies in the band at the mean speed, of the texture that suffers
/// most: an upper estimate, with an encoder finer than the tracker's noise (budget_promise_test: 0.75 of it
/// at most, 0.15 in the middle, for a tracker that sees that it is off takes shorter averages).
double wandering_error(std::span<const PlacedTexture> textures, const WanderingHand& hand,
                       const PrepareOptions& options, double delay_s);

}  // namespace tacto::playback
