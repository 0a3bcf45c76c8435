// SPDX-License-Identifier: GPL-3.0-or-later
// What an identification found, as results that `report` draws. Verb, inputs and details are the caller's.
#pragma once

#include "analysis/identify/report/identification.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// Parameters with their intervals, what could not be told apart, quality; Bode plot of data, model and
/// inverse; residuals. Where the base is the paper's also where the paper contradicts itself.
schema::Results identify_results(const ResponseFit& fit, const ModelChoice& choice,
                                 const schema::Transducer& base, const schema::Transducer& found);
/// The loop's opening and what the operator leaves.
schema::Results identify_results(const LoopFit& fit, const schema::Transducer& found);
/// Both.
schema::Results identify_results(const JointFit& fit, const ModelChoice& choice,
                                 const schema::Transducer& base, const schema::Transducer& found);
/// Resonance and damping over the taps, and what the first foretell of the others.
schema::Results identify_results(const TapsFit& fit, const TapsPrediction& foretold,
                                 const schema::Transducer& found);

}  // namespace tacto::analysis
