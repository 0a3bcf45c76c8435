// SPDX-License-Identifier: GPL-3.0-or-later
// Formats a parameter and its interval with sufficient digits.
#pragma once

#include <string>

#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// "547.730 (547.681 to 547.779)": five significant digits, or as many as give half the interval two digits.
/// "143.06, held" and "143.06, no interval is claimed" without an interval. `claimed`: the fit's
/// claims_intervals().
std::string interval_words(const FittedParameter& parameter, bool claimed);

/// Whether both ends of the interval look equal with this number of significant digits.
bool interval_is_hidden(const FittedParameter& parameter, int digits);

}  // namespace tacto::analysis
