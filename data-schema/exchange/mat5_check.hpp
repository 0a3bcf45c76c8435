// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the tags of a MATLAB file of version 5 against its length.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Whether each array of the file is whole: its tags (also those inside compressed elements and inside
/// structs and cells) state no more bytes than there are, real arrays have as many numbers as their
/// dimensions state, and compressed elements have their checksum. matio checks none of this: of a file that
/// was cut it returns the last variable at full length, with numbers from uninitialised memory. Format: "MAT-
/// File Format", The MathWorks, sections on level 5. Memory: 64 KiB, for a file of any length. Errors:
/// not_found; malformed, with the variable's number and the place in the file; unsuitable, for more than a
/// million arrays. A file that was cut between two variables is whole: it does not state how many it has.
Result<void> check_mat5(const std::string& path);

}  // namespace tacto::schema
