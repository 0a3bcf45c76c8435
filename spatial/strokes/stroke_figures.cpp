// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/stroke_figures.hpp"

#include <utility>

#include "data-schema/base/stroke_rule.hpp"
#include "spatial/strokes/touch_record.hpp"

namespace tacto::spatial {
namespace {

using schema::Result;
using schema::StrokeFigures;

schema::StrokeFigures figures_of(const TouchRecord& record, const Stroke& stroke,
                                 const std::vector<schema::Gap>& gaps) {
  StrokeFigures figures;
  figures.first_frame = record.stored_frame(stroke.frames.begin);
  figures.frames = record.stored_frame(stroke.frames.end) - figures.first_frame;
  figures.length_m = record.length_m(stroke);
  figures.direction = stroke.direction;
  figures.mean_speed_mps = record.mean_speed_mps(stroke);
  figures.mean_normal_n = stroke.force_n;
  const auto near = static_cast<std::uint64_t>(schema::kStrokePause_s * record.header().sample_rate_hz);
  for (const schema::Gap& gap : gaps)
    if (gap.frame + near >= figures.first_frame && gap.frame <= figures.first_frame + figures.frames + near)
      figures.lost_frames += gap.count;
  return figures;
}

}  // namespace

Result<std::vector<StrokeFigures>> stroke_figures(const schema::Recording& recording) {
  const auto without_strokes = [](const schema::Error& error) -> Result<std::vector<StrokeFigures>> {
    if (error.kind == schema::ErrorKind::unsuitable) return std::vector<StrokeFigures>();
    return tl::unexpected(error);
  };
  auto source = open_position_source(recording);
  if (!source) return without_strokes(source.error());
  const auto record = TouchRecord::open(std::move(*source), recording.header, recording.stem);
  if (!record) return without_strokes(record.error());
  std::vector<StrokeFigures> all;
  for (const Stroke& stroke : record->strokes())
    all.push_back(figures_of(*record, stroke, recording.header.gaps));
  return all;
}

}  // namespace tacto::spatial
