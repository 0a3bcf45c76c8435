// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a request: "from_m=0.01&to_m=0.02".
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// `take` is called with each name and finite number, and returns false for a name that is not known.
/// `names`: those that are, for the error. Errors: usage.
schema::Result<void> read_query(const std::string& query, const std::string& names,
                                const std::function<bool(std::string_view name, double value)>& take);

}  // namespace tacto::analysis
