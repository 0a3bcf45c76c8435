// SPDX-License-Identifier: GPL-3.0-or-later
// From two recorded signals of any kind to a frequency response with its noise.
#pragma once

#include <span>
#include <string>

#include "analysis/identify/measure/bode_data.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// From the whole record's spectra, at up to 80 places evenly by octaves: at the strongest bin of each,
/// local_response() over at least 15 bins and 1 Hz, no bin twice. So noise, chirps, steps of sines and sines
/// of whole periods are all told by their own lines alone; what the record's ends make is fitted with them
/// where it shows (chi squared, 2 standard deviations). The noise of each place is the mean of nine
/// neighbours', or its own where that is four times as large. Left out: places driven 60 dB below the
/// strongest, and those whose noise is above a fifth of their response. A resonance narrower than about four
/// times the larger of 1 Hz and 14 / duration is flattened. Errors: unsuitable: fewer than 1,024 samples, or
/// output and input have nothing to do with each other.
schema::Result<BodeData> response_of_record(std::span<const double> input, std::span<const double> output,
                                            double rate_hz, double low_hz, double high_hz,
                                            const std::string& source);

}  // namespace tacto::analysis
