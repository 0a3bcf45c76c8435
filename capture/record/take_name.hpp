// SPDX-License-Identifier: GPL-3.0-or-later
// Names of recordings from subject, surface and take number.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// The words that may be between braces in a template, and their replacements.
using NameParts = std::vector<std::pair<std::string, std::string>>;

/// "{subject}_{surface}_{take}" as an unused name. In the parts, each character other than letters, digits,
/// dot, dash and underscore becomes a dash. The take is one more than the highest of the existing and the
/// running recordings, so the number of a removed one is not used again in between. A folder may precede the
/// name (`folder/`). Errors: usage: a brace that is never closed, a part that does not exist or is empty, a
/// take of 9999, or a name without {take} that is in use.
schema::Result<std::string> name_of_take(const std::string& pattern, const NameParts& parts);

}  // namespace tacto::capture
