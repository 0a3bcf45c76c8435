// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/store_strokes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/stroke_rule.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/recording_frames.hpp"
#include "firmware-host/link/code_range.hpp"
#include "spatial/strokes/touch_record.hpp"

namespace tacto::capture {
namespace {

using schema::Result;

schema::StrokeFigures stored_figures(const spatial::TouchRecord& record, const spatial::Stroke& stroke,
                                     const std::vector<schema::Gap>& gaps) {
  schema::StrokeFigures figures;
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

// The strokes that `spatial` finds; none without a position, or if the position never changes.
// `clipped_samples` is not filled in. `lost_frames` are missing within a stroke (bridge_short_gaps), or
// directly before or after it. Reads the position as TouchRecord::open. Errors: of reading.
Result<std::vector<schema::StrokeFigures>> stroke_figures(const schema::Recording& recording) {
  const auto without_strokes = [](const schema::Error& error) -> Result<std::vector<schema::StrokeFigures>> {
    if (error.kind == schema::ErrorKind::unsuitable) return std::vector<schema::StrokeFigures>();
    return tl::unexpected(error);
  };
  auto source = spatial::open_position_source(recording);
  if (!source) return without_strokes(source.error());
  const auto record = spatial::TouchRecord::open(std::move(*source), recording.header, recording.stem);
  if (!record) return without_strokes(record.error());
  std::vector<schema::StrokeFigures> all;
  for (const spatial::Stroke& stroke : record->strokes())
    all.push_back(stored_figures(*record, stroke, recording.header.gaps));
  return all;
}

// Over all channels. Only codes of a converter can be clipped.
Result<void> count_clipped(const schema::Recording& recording, std::vector<schema::StrokeFigures>& strokes) {
  if (recording.header.format != schema::SampleFormat::pcm32) return {};
  constexpr std::uint64_t kChunk = 1 << 16;
  auto frames = schema::RecordingFrames::open(recording);
  TACTO_TRY(frames);
  std::vector<double> codes;
  for (schema::StrokeFigures& stroke : strokes)
    for (std::size_t k = 0; k < recording.header.channels.size(); ++k) {
      const firmware_host::CodeRange range = firmware_host::code_range(recording.header.channels[k]);
      for (std::uint64_t done = 0; done < stroke.frames; done += codes.size()) {
        codes.resize(std::min(kChunk, stroke.frames - done));
        TACTO_TRY(frames->read_stored(k, stroke.first_frame + done, codes));
        stroke.clipped_samples += static_cast<std::uint64_t>(std::ranges::count_if(
            codes, [&](double code) { return range.clips(static_cast<std::int32_t>(code)); }));
      }
    }
  return {};
}

}  // namespace

Result<void> store_strokes(schema::Recording& recording) {
  auto strokes = stroke_figures(recording);
  TACTO_TRY(strokes);
  if (strokes->empty()) return {};
  TACTO_TRY(count_clipped(recording, *strokes));
  schema::Recording complete = recording;
  complete.header.strokes = std::move(*strokes);
  TACTO_TRY(schema::write_sidecar(complete));
  recording = std::move(complete);
  return {};
}

}  // namespace tacto::capture
