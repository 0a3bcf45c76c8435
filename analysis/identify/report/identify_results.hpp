// SPDX-License-Identifier: GPL-3.0-or-later
// The results of an identification, which `report` draws. The caller adds verb, inputs and details.
#pragma once

#include <string>

#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/report/identification.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// "547.730 (547.681 to 547.779)": five significant digits, or as many as give half the interval two digits.
/// "143.06, held" and "143.06, no interval is claimed" without an interval. `claimed`: the fit's
/// claims_intervals().
std::string interval_words(const FittedParameter& parameter, bool claimed);

/// Whether both ends of the interval look equal with this number of significant digits.
bool interval_is_hidden(const FittedParameter& parameter, int digits);

/// Parameters with their intervals, combinations that are not separately identifiable, quality; Bode plot of
/// data, model and inverse; residuals.
schema::Results identify_results(const ResponseFit& fit, const schema::Transducer& base,
                                 const schema::Transducer& found);
/// The largest loop, its opening and the residual of the operator.
schema::Results identify_results(const LoopFit& fit, const schema::Transducer& found);
/// Both.
schema::Results identify_results(const JointFit& fit, const schema::Transducer& base,
                                 const schema::Transducer& found);
/// Resonance and damping of all taps, and the prediction of later taps from the first ones.
schema::Results identify_results(const TapsFit& fit, const TapsPrediction& predicted,
                                 const schema::Transducer& found);

}  // namespace tacto::analysis
