// SPDX-License-Identifier: GPL-3.0-or-later
// The noise of a response of which nobody measured any: told by what a fit leaves.
#pragma once

#include <complex>
#include <span>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// The data with the noise that makes the residuals likeliest among sigma^2 = a^2 (a vibrometer's), b^2 |H|^2
/// (a lock-in's range, a gain that drifts) and mixes of both in steps of a factor 10 of power, H being the
/// model, a and b from the residuals themselves, which are taken for Gaussian. noise_from_residuals is set.
/// Precondition: as many modelled values as data.
BodeData with_noise_of_residuals(BodeData data, std::span<const std::complex<double>> modelled,
                                 std::size_t parameters);

}  // namespace tacto::analysis
