// SPDX-License-Identifier: GPL-3.0-or-later
// The contradictions in Wiertlewski, Lozada and Hayward 2011, in numbers, beside the identified values.
#pragma once

#include <string>
#include <vector>

#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// A figure as the paper reports it, as its Table I (or its list) gives it, and as identified.
struct PaperFigure {
  std::string what;
  double reported = 0, by_table = 0, identified = 0;
  std::string remark;
};

/// Computed from the presets, not copied: resonance, gains, flatness, loop and lag, R^2, finger, converter,
/// reconstruction filter, stretch factors. `identified` is the value of the given transducer and fit: R^2 for
/// the fit's direction, the lag if it was fitted; NaN if the fit has no such value. Errors: those of
/// read_transducer for the presets, which are built in.
schema::Result<std::vector<PaperFigure>> paper_figures(const schema::Transducer& identified,
                                                       const ResponseFit& fit);

/// Whether a transducer is one of the paper's presets, by its name.
bool is_the_papers(const schema::Transducer& transducer);

}  // namespace tacto::analysis
