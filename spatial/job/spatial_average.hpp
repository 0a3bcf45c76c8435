// SPDX-License-Identifier: GPL-3.0-or-later
// --average: makes the mean of the strokes of a direction.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "spatial/job/spatial_options.hpp"
#include "spatial/job/stroke_job.hpp"
#include "spatial/texture/average_textures.hpp"

namespace tacto::spatial {

/// The strokes that are averaged into one texture.
struct AverageGroup {
  std::vector<StrokeJob> jobs;
  std::string stem;
};

/// Groups by direction, or all strokes in one: NAME if there is one group, otherwise NAME-forward and
/// NAME-backward.
std::vector<AverageGroup> average_groups(const std::vector<StrokeJob>& jobs, bool both_ways,
                                         const std::string& stem);

/// "position" or "correlation", as in files.
std::string name_of(Align align);

/// Parameters of averaging besides the strokes; warnings are appended to `warnings`. `several_recordings`:
/// each stroke is stored with its recording.
struct AverageRun {
  const SpatialOptions& options;
  std::vector<std::string>& warnings;
  const std::function<void(double)>& progress;
  bool several_recordings = false;
};

/// Adds the strokes of one recording to a mean. A stroke that makes no texture, or is at another place, is
/// left out with a warning. Errors: of reading.
schema::Result<void> add_strokes(TextureMaker& maker, const std::vector<StrokeJob>& jobs,
                                 const AverageRun& run, TextureAverager& averager);

/// The mean of a group. A stroke that makes no texture, or is at another place, is left out with a warning.
/// Errors: of TextureAverager::finish(); of reading.
schema::Result<schema::Texture> averaged(TextureMaker& maker, const AverageGroup& group,
                                         const SpatialOptions& options, std::vector<std::string>& warnings,
                                         const std::function<void(double)>& progress);

}  // namespace tacto::spatial
