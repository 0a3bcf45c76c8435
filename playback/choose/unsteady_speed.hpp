// SPDX-License-Identifier: GPL-3.0-or-later
// The error of the displacement that is added when the finger's speed changes during a stroke.
#pragma once

#include <span>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// The speed is a sinusoid about a mean: v (1 + part sin(2 pi rate t)).
struct UnsteadySpeed {
  double speed_mps = 0.05;
  double part = 0.1;
  double rate_hz = 2;
};

/// RMS error of the place by looking ahead, m: with a delay d, a constant acceleration a gives an error of a
/// d (d / 2 + t), where t is the delay of the tracker's speed (for an alpha-beta filter (alpha - beta / 2) /
/// beta ticks; core FingerTracker). Valid for changes that are slow relative to both.
double missed_place_m(const UnsteadySpeed& hand, const PrepareOptions& options, double delay_s);

/// RMS error of the values read there, re the content of the band at the mean speed, for the texture with the
/// largest error: an upper estimate, for an encoder finer than the tracker's noise (budget_promise_test: 0.75
/// of it at most, 0.15 median, because the tracker averages over shorter times when its error is large).
double unsteady_speed_error(std::span<const PlacedTexture> textures, const UnsteadySpeed& hand,
                            const PrepareOptions& options, double delay_s);

}  // namespace tacto::playback
