// SPDX-License-Identifier: GPL-3.0-or-later
// A parameter and its interval for people, with as many digits as show it.
#pragma once

#include <string>

#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// "547.730 (547.681 to 547.779)": five significant digits, and more until half the interval has two.
/// "143.06, held" and "143.06, no interval is claimed" where there is none. `claimed`: the fit's
/// claims_intervals().
std::string interval_words(const FittedParameter& parameter, bool claimed);

/// Whether so few significant digits print both ends of the interval alike.
bool interval_is_hidden(const FittedParameter& parameter, int digits);

}  // namespace tacto::analysis
