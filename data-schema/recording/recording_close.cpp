// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/recording_close.hpp"

#include <fmt/format.h>

#include "data-schema/files/files.hpp"
#include "data-schema/recording/clock_fit.hpp"
#include "data-schema/recording/recording_place.hpp"
#include "data-schema/wav/riff_repair.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kMostPairs = 1000;  // enough for a line and its scatter

// Removes every second pair until there are few enough; keeps the first and the last.
void thin(std::vector<ClockPair>& pairs) {
  while (pairs.size() > kMostPairs) {
    std::vector<ClockPair> fewer;
    for (std::size_t i = 0; i < pairs.size(); i += 2) fewer.push_back(pairs[i]);
    if (pairs.size() % 2 == 0) fewer.push_back(pairs.back());
    pairs = std::move(fewer);
  }
}

void note_clocks(RecordingHeader& header) {
  const auto fit = fit_clock(header.clock_pairs);
  if (!fit) return;
  header.clock_drift_ppm = fit->drift_ppm;
  header.clock_drift_uncertainty_ppm = fit->drift_uncertainty_ppm;
  header.clock_offset_s = fit->offset_s;
  header.clock_scatter_s = fit->scatter_s;
}

// Removes what was noted for frames that did not reach the disk.
void forget_beyond_end(RecordingHeader& header) {
  const auto gaps = std::erase_if(header.gaps, [&](const Gap& gap) { return gap.frame > header.frames; });
  const auto marks =
      std::erase_if(header.marks, [&](const Mark& mark) { return mark.frame > header.frames; });
  if (gaps + marks > 0)
    header.warnings.push_back(fmt::format(
        "{} marks and {} gaps are beyond its last frame, {}, and were removed", marks, gaps, header.frames));
}

}  // namespace

Result<Recording> close_recording(const std::string& stem, RecordingHeader header, EventFile& events) {
  const std::string wav = stem + ".wav";
  const auto frames = repair_riff(wav);
  TACTO_TRY(frames);
  TACTO_TRY(sync_path(wav));
  header.frames = *frames;
  forget_beyond_end(header);
  note_clocks(header);
  thin(header.clock_pairs);
  const auto text = completed_sidecar(header, wav);
  TACTO_TRY(text);
  events.release_room();
  PendingFiles pending;
  TACTO_TRY(pending.write(stem + ".json", *text));
  TACTO_TRY(pending.commit());
  TACTO_TRY(sync_path(folder_of(wav)));
  TACTO_TRY(events.remove());
  return Recording{std::move(header), stem};
}

}  // namespace tacto::schema
