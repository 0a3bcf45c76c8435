// SPDX-License-Identifier: GPL-3.0-or-later
// `tactograph spatial --average` over the strokes of several recordings: one mean of all takes.
#pragma once

#include <string>
#include <vector>

#include "data-schema/report/report.hpp"
#include "spatial/job/spatial_options.hpp"

namespace tacto::spatial {

/// Whether the options request one mean over all recordings: --average, and -o is a plain name. A folder or a
/// name with {} requests one mean per recording.
bool averages_recordings(const SpatialOptions& options);

/// Aligns as within one recording: by position on the bench, which the takes must have in common, or by
/// correlation with the strokes before. A recording without a usable stroke is left out with a warning.
/// Errors: usage, of names; of reading; unsuitable, if two recordings have the same samples, different
/// surfaces or only one of them is simulated (the last two unless --mix is given), or if fewer than two
/// strokes remain.
schema::Result<cli::Report> spatial_takes(const SpatialOptions& options,
                                          const std::vector<std::string>& recordings);

}  // namespace tacto::spatial
