// SPDX-License-Identifier: GPL-3.0-or-later
// The frequency response, with its noise, of two recorded signals of any kind.
#pragma once

#include <span>
#include <string>

#include "analysis/identify/measure/bode_data.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Uses the whole record's spectra at up to 80 places, evenly spaced on a logarithmic axis: local_response()
/// at the strongest bin of each, over at least 15 bins and 1 Hz, without overlap. So noise, chirps, stepped
/// sines and sines of whole periods are each measured at their own lines. The effect of the record's ends is
/// fitted if it is significant (chi squared, 2 standard deviations). The noise of a place is the mean of nine
/// neighbours, or its own if that is four times as large. Left out: places with a drive 60 dB below the
/// strongest, and those whose noise is above a fifth of their response. A resonance narrower than about four
/// times the larger of 1 Hz and 14 / duration is flattened. Errors: unsuitable: fewer than 1,024 samples, or
/// no correlation between input and output.
schema::Result<BodeData> response_of_record(std::span<const double> input, std::span<const double> output,
                                            double rate_hz, double low_hz, double high_hz,
                                            const std::string& source);

}  // namespace tacto::analysis
