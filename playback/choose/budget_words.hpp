// SPDX-License-Identifier: GPL-3.0-or-later
// Texts about the choices that an error budget led to.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "playback/choose/budget.hpp"
#include "playback/choose/unsteady_speed.hpp"

namespace tacto::playback {

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
