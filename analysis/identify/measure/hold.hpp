// SPDX-License-Identifier: GPL-3.0-or-later
// What a converter that holds its samples makes of a response.
#pragma once

#include <complex>
#include <functional>
#include <vector>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

using Response = std::function<std::complex<double>(double frequency_hz)>;

/// The response that is measured between held drive samples and samples of the answer taken at the same
/// instants, over the true one: sum over k of H(f + k fs) hold(f + k fs) / H(f), hold(f) = sinc(f / fs)
/// exp(-i pi f / fs). k from -3 to 3: what is left out is below 1e-6 for a response that falls by 18 dB an
/// octave.
std::complex<double> hold_factor(const Response& response, double frequency_hz, double rate_hz);

/// The data of a continuous drive: divided by hold_factor of a response that is near the true one; an error
/// of e in it comes back as e x 2e-4 at a tenth of the rate. Data that were never held come back as they are.
BodeData without_hold(BodeData data, const Response& response);

}  // namespace tacto::analysis
