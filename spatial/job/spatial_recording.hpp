// SPDX-License-Identifier: GPL-3.0-or-later
// `tactograph spatial` for one recording: selects strokes, makes their textures or mean, writes them
// together, reports.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/report/report.hpp"
#include "data-schema/report/warnings.hpp"
#include "spatial/job/spatial_options.hpp"
#include "spatial/job/stroke_job.hpp"
#include "spatial/job/too_short.hpp"
#include "spatial/texture/make_texture.hpp"

namespace tacto::spatial {

/// The result for a recording; `warnings` are texts for users, in order. Nothing is printed, so that several
/// recordings can be processed in parallel.
struct SpatialOutcome {
  schema::Result<cli::Report> report = cli::Report{};
  std::vector<cli::Warning> warnings;
  TooShort too_short = {};  ///< not among the warnings
};

/// One recording of several, open, with its selected strokes.
struct Take {
  TextureMaker maker;
  std::vector<StrokeJob> jobs;
};

/// Errors: of opening; unsuitable, without strokes.
schema::Result<Take> open_take(const SpatialOptions& options, const std::string& recording,
                               std::vector<std::string>& warnings, TooShort& too_short);

/// `stem` is the name of the textures; `progress` is called with fractions from 0 to 1. All textures of a
/// recording appear together, or none. Strokes that are too short are left out; an error if nothing is left.
/// Errors: of opening, making and writing; usage, if a texture exists
/// already.
SpatialOutcome spatial_recording(const SpatialOptions& options, const std::string& recording,
                                 const std::string& stem, const std::function<void(double)>& progress);

}  // namespace tacto::spatial
