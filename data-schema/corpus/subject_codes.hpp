// SPDX-License-Identifier: GPL-3.0-or-later
// Removes the codes of subjects from files that are given away.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// A code is found in capital and small letters, and with other spaces, underscores and hyphens or without
/// them. Codes of three or more characters are found anywhere in a text, shorter ones where neither a further
/// letter (beside a letter) nor a further digit (beside a digit) is adjacent: "7" in "7 strokes" and "oak7",
/// not in "70 mm/s". So more is found than was meant, not less.
class SubjectCodes {
 public:
  /// False for a code that is not ASCII: its letters can be stored in several ways, and not all would be
  /// found.
  [[nodiscard]] bool add(const std::string& code);
  bool empty() const { return codes_.empty(); }
  bool in(std::string_view text) const { return !empty() && without(text) != text; }
  /// The text with "[subject]" in place of each code.
  std::string without(std::string_view text) const;

 private:
  std::set<std::string, std::less<>> codes_;  // small letters, without separators
};

/// A recording's name, and the one that its files have instead.
struct NewStem {
  std::string before, after;
};

/// "oak-01.texture.wav" of the stem "oak" with the new stem; other text without codes.
std::string with_new_stem(const std::string& text, const NewStem& stem, const SubjectCodes& codes);

/// A sidecar, or another document, without `subject` and without codes in its texts, in members that no
/// schema names (x_...) also in their names. Fixed words, dates and checksums stay. Errors: of the file;
/// unsuitable, if it has members that are neither free nor in the schema.
Result<std::string> without_subjects(const std::string& path, const NewStem& stem, const SubjectCodes& codes);

}  // namespace tacto::schema
