// SPDX-License-Identifier: GPL-3.0-or-later
// `tactograph spatial --average` over the strokes of several recordings: one mean of all takes.
#pragma once

#include <string>
#include <vector>

#include "data-schema/report/report.hpp"
#include "spatial/job/spatial_options.hpp"

namespace tacto::spatial {

/// Whether the options ask for one mean over all recordings: --average, and -o is a plain name, neither a
/// folder nor with {} in it, which name a mean of each recording.
bool asks_for_takes(const SpatialOptions& options);

/// Aligns as within one recording: by position on the bench, which the takes must share, or by correlation
/// with those before. A recording of which nothing can be averaged is left out with a warning. Errors: usage,
/// of names; of reading; unsuitable, where fewer than two strokes are left.
schema::Result<cli::Report> spatial_takes(const SpatialOptions& options,
                                          const std::vector<std::string>& recordings);

}  // namespace tacto::spatial
