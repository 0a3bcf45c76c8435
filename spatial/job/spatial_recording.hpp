// SPDX-License-Identifier: GPL-3.0-or-later
// `tactograph spatial` on one recording: which strokes, their textures or mean, written together, reported.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/report/report.hpp"
#include "data-schema/report/warnings.hpp"
#include "spatial/job/spatial_options.hpp"
#include "spatial/job/stroke_job.hpp"
#include "spatial/texture/make_texture.hpp"

namespace tacto::spatial {

/// What became of a recording; `warnings` are for people, in order. Made without printing, so that several
/// recordings can be worked on side by side.
struct SpatialOutcome {
  schema::Result<cli::Report> report = cli::Report{};
  std::vector<cli::Warning> warnings;
};

/// One recording of several: ready to make textures of the strokes that are asked for.
struct Take {
  TextureMaker maker;
  std::vector<StrokeJob> jobs;
};

/// Errors: of opening; unsuitable, without strokes.
schema::Result<Take> open_take(const SpatialOptions& options, const std::string& recording,
                               std::vector<std::string>& warnings);

/// `stem` names the textures; `progress` hears fractions from 0 to 1. All textures of a recording appear
/// together, or none. Errors: of opening, making and writing; usage, where a texture is there already.
SpatialOutcome spatial_recording(const SpatialOptions& options, const std::string& recording,
                                 const std::string& stem, const std::function<void(double)>& progress);

}  // namespace tacto::spatial
