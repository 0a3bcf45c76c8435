// SPDX-License-Identifier: GPL-3.0-or-later
// What the tick kernel's choices cost on this machine, and the error they leave: the real-time stages of a
// table of measured choices.
#pragma once

#include <vector>

#include "data-schema/results/trade_table.hpp"

namespace tacto::analysis {

/// - "reading": nearest, linear, hermite, sinc, per tick: a whole tick under a moving finger (place, two
/// levels,
///   gain, envelope, limits) without filter; errors by 2.2 to 64 samples a period of a sine: RMS over its
///   phases at the worst place between two samples, re the sine's RMS; single precision, as it runs; the
///   largest at so many samples a period or more.
/// - "inverse": "tap", per tap.
/// - "hysteresis": "undone", per tick: 16 plays and the section behind them.
/// Median CPU time of this thread; a second of it in all.
std::vector<schema::MeasuredChoice> measure_reading_choices();

}  // namespace tacto::analysis
