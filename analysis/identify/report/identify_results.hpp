// SPDX-License-Identifier: GPL-3.0-or-later
// The results of an identification, which `report` draws. The caller adds verb, inputs and details.
#pragma once

#include "analysis/identify/report/identification.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

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
