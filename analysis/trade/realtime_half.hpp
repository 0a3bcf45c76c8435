// SPDX-License-Identifier: GPL-3.0-or-later
// Error and cost of each choice between a texture and the tray, on a given texture and transducer.
#pragma once

#include <functional>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/results/trade_table.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// Cost and error of the tick kernel's choices on this machine, for the table of measured choices:
/// - "reading": nearest, linear, hermite, sinc, per tick: a whole tick under a moving finger (place, two
///   levels, gain, envelope, limits) without filter; errors for 2.2 to 64 samples per period of a sine: RMS
///   over its phases at the worst place between two samples, re the RMS of the sine; in single precision, as
///   in the tick; the largest at so many samples per period or more.
/// - "inverse": "tap", per tap.
/// - "hysteresis": "undone", per tick: 16 play operators and the section behind them.
/// Median CPU time of this thread; about a second in all.
std::vector<schema::MeasuredChoice> measure_reading_choices();

/// The texture is looped under a finger. Each choice is varied alone from the default (2 kHz, hermite at 16
/// samples per period, full inverse of 2 ms, with prediction; fingers of 25, 100 and 200 mm/s with exact
/// positions, the error is the worst of the three), and in pairs if they interact. Knobs: "interpolation",
/// "samples per period", "interpolation x samples per period" (for these three the error is that of the read
/// force alone), "inverse", "inverse, amplitudes alone", "inverse delay", "look ahead", "between counts",
/// "tick rate", "tick rate x inverse", "tick rate x delay compensation", "pyramid", "precision",
/// "hysteresis", "loop". Errors against playback/render/reference over 15-500 Hz, re the target displacement;
/// cost per tick, median CPU time of this thread; memory of the samples; latency of the tray behind the
/// finger, for "loop" from the encoder's edge to its drive. A refused choice (an inverse with a residual over
/// a tenth) has an error of 1 and a note. Takes about 5 s. Errors: unsuitable: prepare() cannot play the
/// texture at all.
schema::Result<std::vector<TradeRow>> measure_realtime(const schema::Texture& texture,
                                                       const schema::Transducer& transducer,
                                                       const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
