// SPDX-License-Identifier: GPL-3.0-or-later
// Files of other programs that import does not read, known by their first bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tacto::capture {

struct ForeignFormat {
  std::string_view what;      ///< "a TDMS file of LabVIEW"
  std::string_view remedy;    ///< which export to use, until there is a reader for it
  bool may_be_sound = false;  ///< libsndfile writes and reads sound in files of this kind
};

/// What a file is by its first bytes (some hundred are enough for most kinds); `file` is its name, whose
/// ending says what is in an archive, or that it is a MATLAB 4 file. nullopt for text and anything else.
std::optional<ForeignFormat> foreign_format(const std::string& file, std::string_view head);

}  // namespace tacto::capture
