// SPDX-License-Identifier: GPL-3.0-or-later
// Files of other programs that import does not read, recognised from their first bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tacto::capture {

struct ForeignFormat {
  std::string_view what;      ///< "a TDMS file of LabVIEW"
  std::string_view remedy;    ///< the export to use, until there is a reader for the format
  bool may_be_sound = false;  ///< libsndfile writes and reads audio in files of this kind
};

/// The kind of a file from its first bytes (some hundred are sufficient for most kinds). `file` is its name:
/// its extension shows the kind of an archive, or a MATLAB 4 file. nullopt for text and anything else.
std::optional<ForeignFormat> foreign_format(const std::string& file, std::string_view head);

}  // namespace tacto::capture
