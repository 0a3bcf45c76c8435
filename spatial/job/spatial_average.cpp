// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/spatial_average.hpp"

#include <fmt/format.h>

#include "data-schema/base/quantity.hpp"
#include "spatial/texture/align_textures.hpp"
#include "spatial/texture/average_textures.hpp"

namespace tacto::spatial {

using schema::ErrorKind;
using schema::Result;

namespace {

// Shifts a texture for the best agreement with the strokes before it.
class Aligner {
 public:
  Aligner(TextureMaker& maker, const SpatialOptions& options, std::vector<std::string>& warnings)
      : maker_(maker), options_(options), warnings_(warnings) {}

  Result<schema::Texture> aligned(schema::Texture texture, const StrokeJob& job,
                                  const TextureAverager& averager, schema::AveragedStroke& stroke) const {
    if (options_.align == Align::position || averager.strokes() == 0) return texture;
    const double pitch_m = texture.signal.pitch_m;
    const auto mean = averager.mean();
    const Alignment found =
        align({averager.first(), mean}, {texture.source_origin_m / pitch_m, texture.signal.values},
              options_.align_range_m / pitch_m);
    stroke.correlation = found.correlation;
    if (!found.found) {
      warnings_.push_back(fmt::format(
          "stroke {} correlates with those before it at no shift within {}: it is averaged without a shift",
          job.number, schema::for_people(options_.align_range_m, schema::Dimension::length)));
      return texture;
    }
    stroke.shift_m = found.shift * pitch_m;
    return maker_.make(job.stroke, job.number, stroke.shift_m);
  }

 private:
  TextureMaker& maker_;
  const SpatialOptions& options_;
  std::vector<std::string>& warnings_;
};

// `named`: whether the stroke stores its recording. In a mean of one recording the file's `source` does.
Result<void> add_named_stroke(TextureMaker& maker, const StrokeJob& job, const Aligner& aligner, bool named,
                              TextureAverager& averager) {
  auto made = maker.make(job.stroke, job.number);
  TACTO_TRY(made);
  schema::AveragedStroke stroke{job.number, made->source.from_s, made->source.to_s, job.stroke.direction, 0};
  if (named) {
    stroke.recording = made->source.recording;
    stroke.recording_sha256 = made->source.recording_sha256;
  }
  const auto texture = aligner.aligned(std::move(*made), job, averager, stroke);
  TACTO_TRY(texture);
  return averager.add(*texture, stroke);
}

}  // namespace

std::vector<AverageGroup> average_groups(const std::vector<StrokeJob>& jobs, bool both_ways,
                                         const std::string& stem) {
  AverageGroup forward{{}, stem + "-forward"}, backward{{}, stem + "-backward"};
  for (const StrokeJob& job : jobs)
    (both_ways || job.stroke.direction > 0 ? forward : backward).jobs.push_back(job);
  std::vector<AverageGroup> groups;
  for (AverageGroup& group : {std::ref(forward), std::ref(backward)})
    if (!group.jobs.empty()) groups.push_back(std::move(group));
  if (groups.size() == 1) groups.front().stem = stem;
  return groups;
}

Result<void> add_strokes(TextureMaker& maker, const std::vector<StrokeJob>& jobs, const AverageRun& run,
                         TextureAverager& averager) {
  const Aligner aligner(maker, run.options, run.warnings);
  for (const StrokeJob& job : jobs) {
    const auto added = add_named_stroke(maker, job, aligner, run.several_recordings, averager);
    if (!added && added.error().kind != ErrorKind::unsuitable) return schema::forward_error(added);
    if (!added)
      run.warnings.push_back(
          fmt::format("stroke {} is not averaged: {}", job.number, schema::message(added.error())));
    run.progress(static_cast<double>(&job - jobs.data() + 1) / static_cast<double>(jobs.size()));
  }
  return {};
}

std::string name_of(Align align) {
  return align == Align::position ? "position" : "correlation";
}

Result<schema::Texture> averaged(TextureMaker& maker, const AverageGroup& group,
                                 const SpatialOptions& options, std::vector<std::string>& warnings,
                                 const std::function<void(double)>& progress) {
  TextureAverager averager;
  TACTO_TRY(add_strokes(maker, group.jobs, {options, warnings, progress, false}, averager));
  auto texture = averager.finish(name_of(options.align));
  if (!texture) texture.error().where = maker.record().where();
  return texture;
}

}  // namespace tacto::spatial
