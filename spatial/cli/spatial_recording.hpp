// SPDX-License-Identifier: GPL-3.0-or-later
// `tactograph spatial` on one recording: which strokes, their textures or mean, written together, reported.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/cli/report.hpp"
#include "spatial/cli/spatial_options.hpp"

namespace tacto::spatial {

/// What became of a recording; `warnings` are for people, in order. Made without printing, so that several
/// recordings can be worked on side by side.
struct SpatialOutcome {
  schema::Result<cli::Report> report = cli::Report{};
  std::vector<std::string> warnings;
};

/// `stem` names the textures; `progress` hears fractions from 0 to 1. All textures of a recording appear
/// together, or none. Errors: of opening, making and writing; usage, where a texture is there already.
SpatialOutcome spatial_recording(const SpatialOptions& options, const std::string& recording,
                                 const std::string& stem, const std::function<void(double)>& progress);

}  // namespace tacto::spatial
