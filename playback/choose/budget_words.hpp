// SPDX-License-Identifier: GPL-3.0-or-later
// Texts about the choices that an error budget led to.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "playback/choose/budget.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

// The error of the displacement that is added when the finger's speed changes during a stroke.

/// The speed is a sinusoid about a mean: v (1 + part sin(2 pi rate t)).
struct UnsteadySpeed {
  double speed_mps = 0.05;
  double part = 0.1;
  double rate_hz = 2;
};

/// RMS error of the values read there, re the content of the band at the mean speed, for the texture with the
/// largest error: an upper estimate, for an encoder finer than the tracker's noise (budget_promise_test: 0.75
/// of it at most, 0.15 median, because the tracker averages over shorter times when its error is large).
double unsteady_speed_error(std::span<const PlacedTexture> textures, const UnsteadySpeed& hand,
                            const PrepareOptions& options, double delay_s);

/// Part of the predicted error: the kernel's rounding, -105 dB, and the finest content that is omitted, -100
/// dB.
inline constexpr double kKernelsOwnError = 1.6e-5;

/// Resolution of the measured cost of a tick.
inline constexpr double kAlikeNs = 1;

/// "nearest", "linear", "hermite", "sinc": the names in a table of measured choices.
std::string_view to_string(wire::Interpolation interpolation);
std::optional<wire::Interpolation> interpolation_of(std::string_view word);

/// "0.052 %"
std::string percent(double part);

/// Rounded up to two digits: "0.034%".
std::string percent_or_more(double part);

/// The largest part of a choice's error, in words.
std::string limited_by(const TickChoice& choice);

/// The error that a hand with changing speed adds, in words.
std::string words_of_unsteady_speed(double error, const UnsteadySpeed& hand, double delay_s);

/// The best of choices that all keep the budget: by cost, or by error first. Precondition: not empty.
TickChoice best_of(std::vector<TickChoice> choices, bool most_exact);

/// Why this choice was made.
std::vector<std::string> reasons_for(const TickChoice& chosen, const std::vector<TickChoice>& all,
                                     const TickBudget& budget);

}  // namespace tacto::playback
