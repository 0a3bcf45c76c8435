// SPDX-License-Identifier: GPL-3.0-or-later
// `spatial --quality` and `--max-error`: choice of method and grid from measured errors, and the report of
// --explain.
#pragma once

#include <vector>

#include "data-schema/report/report.hpp"
#include "spatial/job/spatial_options.hpp"
#include "spatial/job/stroke_job.hpp"
#include "spatial/spectrogram/budget.hpp"
#include "spatial/strokes/touch_record.hpp"

namespace tacto::spatial {

struct ChosenTexture {
  TextureOptions options;  ///< including method and grid
  cli::Report report;      ///< the choice; with --explain also the alternatives and the table
};

/// Errors: usage, for a band without an upper limit; unsuitable, if no choice keeps the budget; of reading
/// the table of measured choices.
schema::Result<ChosenTexture> choose_texture(const SpatialOptions& options, const TextureOptions& target,
                                             const TouchRecord& record, const std::vector<StrokeJob>& jobs);

}  // namespace tacto::spatial
