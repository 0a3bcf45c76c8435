// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates the noise of a response without measured noise from the residuals of a fit.
#pragma once

#include <complex>
#include <span>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// Sets the noise with the largest likelihood among sigma^2 = a^2 (a vibrometer's), b^2 |H|^2 (a lock-in's
/// range, a drifting gain) and mixes of both in steps of a factor 10 of power. H is the model; a and b come
/// from the residuals, which are assumed to be Gaussian. Sets noise_from_residuals. Precondition: equal
/// numbers of modelled and measured values.
BodeData with_noise_of_residuals(BodeData data, std::span<const std::complex<double>> modelled,
                                 std::size_t parameters);

}  // namespace tacto::analysis
