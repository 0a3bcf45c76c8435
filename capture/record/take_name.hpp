// SPDX-License-Identifier: GPL-3.0-or-later
// Names of recordings made of who touched what, for the how-manieth time.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// What may stand between braces in a template, and what it stands for.
using NameParts = std::vector<std::pair<std::string, std::string>>;

/// "{subject}_{surface}_{take}" as a name that is free: the parts with other signs than letters, digits, dot,
/// dash and underscore made dashes; the take is one more than the highest that a recording, or one under way,
/// has there: the number of one that was removed does not come again in between. `folder/` may stand before.
/// Errors: usage: a brace that is never closed, a part that there isn't or that is empty, a take 9999, or a
/// name without {take} that is taken.
schema::Result<std::string> name_of_take(const std::string& pattern, const NameParts& parts);

}  // namespace tacto::capture
