// SPDX-License-Identifier: GPL-3.0-or-later
// Explanations of the residuals of a fit; each of them is fitted.
#pragma once

#include <string>

#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

struct MisfitReason {
  std::string words;            ///< the explanation, or that none was found
  bool one_mode_short = false;  ///< the explanation contains a second mode
  bool is_lag = false;          ///< the explanation is a lag
  double left = 1;              ///< ratio of the residuals' squares with and without the explanation
  bool is_noise = false;        ///< the remaining residuals are noise of the same size over the band
};

/// Tries a second mode, a lag that is the same at all frequencies, and a pure delay (it rotates the phase in
/// proportion to frequency and does not change the amplitude; up to two periods of the highest frequency, of
/// either sign). The result is the first of them that leaves less than half of the squares; a second mode has
/// to leave less than a lag. If its remaining residuals are not noise, a second mode and a delay are fitted
/// together and reported if they leave noise, because a fit of one of them is distorted by the other. The
/// delay is searched in steps of an eighth of a period; from the best step on it is a parameter of the fit.
/// Precondition: `plain` is fit_values(data, choice, base), and the noise of `data` is known.
MisfitReason misfit_reason(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base,
                           const ResponseFit& plain);

}  // namespace tacto::analysis
