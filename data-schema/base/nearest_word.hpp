// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions for misspelt words.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tacto::schema {

/// The word that takes the fewest typing errors (a letter left out, added, replaced, or two swapped: optimal
/// string alignment), if these are at most a third of its letters, or one; upper and lower case are alike.
/// Empty if no word is that near.
std::string nearest_word(std::string_view typed, std::span<const std::string> words);

/// " (did you mean 'word'?)", or nothing.
std::string did_you_mean(std::string_view typed, std::span<const std::string> words);

}  // namespace tacto::schema
