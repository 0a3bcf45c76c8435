// SPDX-License-Identifier: GPL-3.0-or-later
// Where Wiertlewski, Lozada and Hayward 2011 contradict themselves, in numbers beside what was identified.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/transducer.hpp"

namespace tacto::analysis {

/// A figure as the paper reports it, as its own Table I gives it, and as it was identified.
struct PaperFigure {
  std::string what;
  double reported = 0, by_table = 0, identified = 0;
  std::string remark;
};

/// Computed from the presets, not copied: resonance, static gain, loop and lag. `identified` is what the
/// given transducer says, and the lag that was fitted; NaN where none was. Errors: as read_transducer of the
/// presets, which are built in.
schema::Result<std::vector<PaperFigure>> paper_figures(const schema::Transducer& identified,
                                                       std::optional<double> lag_rad = {});

/// Whether a transducer is the paper's, by its name.
bool is_the_papers(const schema::Transducer& transducer);

}  // namespace tacto::analysis
