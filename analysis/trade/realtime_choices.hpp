// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of the tick kernel's choices on this machine, and their errors: the real-time stages of a table of
// measured choices.
#pragma once

#include <vector>

#include "data-schema/results/trade_table.hpp"

namespace tacto::analysis {

/// - "reading": nearest, linear, hermite, sinc, per tick: a whole tick under a moving finger (place, two
///   levels, gain, envelope, limits) without filter; errors for 2.2 to 64 samples per period of a sine: RMS
///   over its phases at the worst place between two samples, re the RMS of the sine; in single precision, as
///   in the tick; the largest at so many samples per period or more.
/// - "inverse": "tap", per tap.
/// - "hysteresis": "undone", per tick: 16 play operators and the section behind them.
/// Median CPU time of this thread; about a second in all.
std::vector<schema::MeasuredChoice> measure_reading_choices();

}  // namespace tacto::analysis
