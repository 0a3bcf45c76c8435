// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/store_strokes.hpp"

#include <algorithm>
#include <vector>

#include "data-schema/recording/recording_frames.hpp"
#include "firmware-host/link/code_range.hpp"
#include "spatial/strokes/stroke_figures.hpp"

namespace tacto::capture {
namespace {

using schema::Result;

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
  auto strokes = spatial::stroke_figures(recording);
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
