// SPDX-License-Identifier: GPL-3.0-or-later
// --average: the strokes of a direction to their mean.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "spatial/cli/spatial_options.hpp"
#include "spatial/cli/stroke_job.hpp"

namespace tacto::spatial {

/// Strokes that are averaged into one texture.
struct AverageGroup {
  std::vector<StrokeJob> jobs;
  std::string stem;
};

/// By direction, or all in one: NAME where there is one group, else NAME-forward and NAME-backward.
std::vector<AverageGroup> average_groups(const std::vector<StrokeJob>& jobs, bool both_ways,
                                         const std::string& stem);

/// The mean of a group. A stroke that makes no texture, or lies elsewhere, is left out with a warning.
/// Errors: of TextureAverager::finish(); of reading.
schema::Result<schema::Texture> averaged(TextureMaker& maker, const AverageGroup& group,
                                         const SpatialOptions& options, std::vector<std::string>& warnings,
                                         const std::function<void(double)>& progress);

}  // namespace tacto::spatial
