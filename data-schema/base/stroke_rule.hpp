// SPDX-License-Identifier: GPL-3.0-or-later
// The definition of a stroke, for recordings and sessions: least length, longest pause.
#pragma once

#include <string_view>

namespace tacto::schema {

/// A stroke is a motion of the finger in one direction over at least kShortestStroke_m and, in a recording,
/// over at least kShortestOfLongest of its longest motion. A pause of kStrokePause_s ends it, and so does a
/// reversal; pauses below that do not.
inline constexpr double kShortestStroke_m = 5e-3;
inline constexpr double kShortestOfLongest = 0.05;
inline constexpr double kStrokePause_s = 0.1;

/// The same for messages and help.
inline constexpr std::string_view kStrokeRule =
    "a motion of the finger in one direction over at least 5 mm and 5 % of the longest motion; pauses below "
    "0.1 s do not end it";

}  // namespace tacto::schema
