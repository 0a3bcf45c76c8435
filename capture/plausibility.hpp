// SPDX-License-Identifier: GPL-3.0-or-later
// Samples that no touch can have given: reported, never changed.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/recording.hpp"

namespace tacto::capture {

/// The largest magnitude that a quantity has at a bench where a finger slides, in its SI unit; infinity where
/// there is none. Wide on purpose: beyond it the unit or the scale is wrong.
double largest_plausible(std::string_view quantity);

/// Samples that stand alone: far from both neighbours, on the same side of both, and five times larger or
/// smaller than the median of the five samples around (a digit or an exponent lost on the way). Far is ten
/// times what 99 % of the channel's samples are from their own median of five, and ten times its finest step.
/// Real transients, steps and noise have neighbours that follow, and pass. Values as stored or physical,
/// 0-based results, in order.
std::vector<std::size_t> lone_samples(std::span<const double> values);

/// Says of a sample where it is: "line 4229, 4.227 s".
using SampleName = std::function<std::string(std::size_t sample)>;

/// One line for each thing to warn of: values beyond largest_plausible(), lone samples (the first few by
/// name, and how many there are), a channel that never changes. `stored` as in the file.
std::vector<std::string> implausible(const schema::Channel& channel, std::span<const double> stored,
                                     const SampleName& name_of);

}  // namespace tacto::capture
