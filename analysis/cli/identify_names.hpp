// SPDX-License-Identifier: GPL-3.0-or-later
// What identify's files are called.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Errors: usage, where the transducer file has no name: with one to take, after what is to be written beside
/// it; where two of the three are one file.
schema::Result<void> check_named(const std::string& stem, const std::string& results,
                                 const std::string& picture);

}  // namespace tacto::analysis
