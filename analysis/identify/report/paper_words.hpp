// SPDX-License-Identifier: GPL-3.0-or-later
// Where Wiertlewski, Lozada and Hayward 2011 contradict themselves, in numbers beside what was identified.
#pragma once

#include <string>
#include <vector>

#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// A figure as the paper reports it, as its own Table I (or its own list) gives it, and as it was identified.
struct PaperFigure {
  std::string what;
  double reported = 0, by_table = 0, identified = 0;
  std::string remark;
};

/// Computed from the presets, not copied: resonance, gains, what is flat and what is not, loop and lag, R^2,
/// a finger, the converter, the reconstruction filter, the stretch factors. `identified` is what the given
/// transducer and its fit say, R^2 of the fit's direction, the lag where one was fitted; NaN where a fit can
/// say nothing. Errors: as read_transducer of the presets, which are built in.
schema::Result<std::vector<PaperFigure>> paper_figures(const schema::Transducer& identified,
                                                       const ResponseFit& fit);

/// Whether a transducer is the paper's, by its name.
bool is_the_papers(const schema::Transducer& transducer);

}  // namespace tacto::analysis
