// SPDX-License-Identifier: GPL-3.0-or-later
// One message about all strokes and motions that are too short for a texture.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tacto::spatial {

/// In one recording.
struct TooShort {
  std::string recording;
  std::vector<int> strokes;   ///< numbers of strokes shorter than a period of the lowest frequency
  std::size_t motions = 0;    ///< number of motions shorter than a stroke (stroke_rule.hpp)
  bool nothing_left = false;  ///< no stroke is left for a texture

  bool any() const { return !strokes.empty() || motions > 0; }
};

/// "oak: strokes 2, 3; 1 motion"
std::string words_of(const TooShort& one);

/// How many, in which recordings, and what to do; none if nothing is too short.
std::optional<std::string> too_short_sentence(std::span<const TooShort> all);

}  // namespace tacto::spatial
