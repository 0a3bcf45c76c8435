// SPDX-License-Identifier: GPL-3.0-or-later
// The reports of `identify`.
#pragma once

#include "analysis/identify/report/identification.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// Each function gives the report of one kind of identification; `file` is the written file.
cli::Report response_report(const ResponseFit& fit, const schema::Transducer& base,
                            const schema::Transducer& found, const std::string& file);
/// If `base` is the paper's transducer: its contradictions together with the measured values.
void add_paper(cli::Report& report, const schema::Transducer& base, const schema::Transducer& found,
               const ResponseFit& fit);
cli::Report loop_report(const LoopFit& fit, const schema::Transducer& found, const std::string& file);
cli::Report joint_report(const JointFit& fit, const schema::Transducer& base, const schema::Transducer& found,
                         const std::string& file);
cli::Report taps_report(const TapsFit& fit, const TapsPrediction& predicted, const schema::Transducer& found,
                        const std::string& file);

}  // namespace tacto::analysis
