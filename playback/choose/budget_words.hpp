// SPDX-License-Identifier: GPL-3.0-or-later
// A budget's decision in words.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "playback/choose/budget.hpp"
#include "playback/choose/wandering_hand.hpp"

namespace tacto::playback {

/// Of what is predicted: the kernel's rounding, -105 dB, and what a texture's finest content leaves out, -100
/// dB.
inline constexpr double kKernelsOwnError = 1.6e-5;

/// What a measurement of a tick tells apart.
inline constexpr double kAlikeNs = 1;

/// "nearest", "linear", "hermite", "sinc": the names in a table of measured choices.
std::string_view to_string(wire::Interpolation interpolation);
std::optional<wire::Interpolation> interpolation_of(std::string_view word);

/// "0.052 %"
std::string percent(double part);

/// Rounded up to two digits: "0.034%".
std::string percent_or_more(double part);

/// What most of a choice's error is of.
std::string limited_by(const TickChoice& choice);

/// What a hand that does not go evenly adds to the error.
std::string words_of_hand(double error, const WanderingHand& hand, double delay_s);

/// The best of some, none of which is refused: by cost, or by error first. Precondition: there is one.
TickChoice best_of(std::vector<TickChoice> choices, bool most_exact);

/// Why this one of all was chosen.
std::vector<std::string> reasons_for(const TickChoice& chosen, const std::vector<TickChoice>& all,
                                     const TickBudget& budget);

}  // namespace tacto::playback
