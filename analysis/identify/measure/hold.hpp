// SPDX-License-Identifier: GPL-3.0-or-later
// The effect of a converter that holds its samples on a measured response.
#pragma once

#include <complex>
#include <functional>
#include <vector>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

using Response = std::function<std::complex<double>(double frequency_hz)>;

/// Ratio of the response between held drive samples and simultaneous samples of the answer to the true
/// response: sum over k of H(f + k fs) hold(f + k fs) / H(f), hold(f) = sinc(f / fs) exp(-i pi f / fs). k is
/// from -3 to 3; the other terms are below 1e-6 for a response that falls by 18 dB per octave.
std::complex<double> hold_factor(const Response& response, double frequency_hz, double rate_hz);

/// Converts the data to those of a continuous drive by dividing by hold_factor of a response near the true
/// one. An error e of that response causes an error of e x 2e-4 at a tenth of the rate. Data without a hold
/// are unchanged.
BodeData without_hold(BodeData data, const Response& response);

}  // namespace tacto::analysis
