// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the model of a response: what is added to one mode.
#pragma once

#include <string>

#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// Fits one mode, one mode with a delay, a reconstruction filter (actuators only) or a lag (unless slow loops
/// measured the hysteresis), and all combinations of second mode, delay and filter. Each is fitted kFolds
/// times without every kFolds-th frequency and compared with the data there (cross-validation; Stone 1974),
/// by the deviance of Gaussian noise: |error|^2 / noise^2 + 4 log noise at each frequency. A model is worse
/// than another if the sum of the differences is above two of its standard errors, the root of the sum of
/// their squares. For linear parameters without effect that sum is chi squared minus twice their number
/// (Stone 1977: Akaike's criterion), so noise causes it for one parameter in 1e-5 of cases. The result is the
/// model with the fewest parameters that is not worse than the best, and no misfit unless the best is one. A
/// model whose errors are within a bound of the noise is not worse. Models that did not converge, or whose
/// two modes are nearer than 5 % or one of them has no resonance, are not chosen unless there is no other.
///
/// `one_mode` is the fit of one mode to `measured`; it is returned if there are fewer than 2
/// kLeastFrequencies. Sets choice_words, tried, and a suggestion for a misfit.
ResponseFit best_model(const BodeData& measured, ResponseFit one_mode, const schema::Transducer& base);

inline constexpr std::size_t kFolds = 8;

/// What the model of a fit has beyond one mode, with the values, and what playback does not undo of it; empty
/// for one mode.
std::string extension_words(const ResponseFit& fit);

}  // namespace tacto::analysis
