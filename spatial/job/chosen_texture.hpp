// SPDX-License-Identifier: GPL-3.0-or-later
// `spatial --quality` and `--max-error`: method and grid by what was measured, and the words for --explain.
#pragma once

#include <vector>

#include "data-schema/report/report.hpp"
#include "spatial/job/spatial_options.hpp"
#include "spatial/job/stroke_job.hpp"
#include "spatial/spectrogram/budget.hpp"
#include "spatial/strokes/touch_record.hpp"

namespace tacto::spatial {

struct ChosenTexture {
  TextureOptions options;  ///< with method and grid in place
  cli::Report report;      ///< what was chosen; with --explain what else was tried, and by which table
};

/// Errors: usage, for a band that does not end; unsuitable, where no choice keeps the promise; of reading the
/// table of measured choices.
schema::Result<ChosenTexture> choose_texture(const SpatialOptions& options, const TextureOptions& target,
                                             const TouchRecord& record, const std::vector<StrokeJob>& jobs);

}  // namespace tacto::spatial
