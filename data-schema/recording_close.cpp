// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording_close.hpp"

#include <algorithm>
#include <cmath>

#include "data-schema/files.hpp"
#include "data-schema/recording_place.hpp"
#include "data-schema/riff_repair.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kMostPairs = 1000;  // enough for a line and its scatter
constexpr double kShortestFit_s = 10;     // over less the host's own lateness tells more than the clocks

// Every second pair is left out until there are few; the first and the last stay.
void thin(std::vector<ClockPair>& pairs) {
  while (pairs.size() > kMostPairs) {
    std::vector<ClockPair> fewer;
    for (std::size_t i = 0; i < pairs.size(); i += 2) fewer.push_back(pairs[i]);
    if (pairs.size() % 2 == 0) fewer.push_back(pairs.back());
    pairs = std::move(fewer);
  }
}

// Least squares of the device's seconds over the host's; none where they span too little.
std::optional<double> drift_ppm(const std::vector<ClockPair>& pairs) {
  if (pairs.size() < 3 || pairs.back().host_s - pairs.front().host_s < kShortestFit_s) return std::nullopt;
  const ClockPair first = pairs.front();
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const ClockPair& pair : pairs) {
    const double host_s = pair.host_s - first.host_s;
    const double ahead_s = pair.device_s - first.device_s - host_s;
    n += 1, x += host_s, y += ahead_s, xx += host_s * host_s, xy += host_s * ahead_s;
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return std::isfinite(slope) ? std::optional(1e6 * slope) : std::nullopt;
}

// What was noted of frames that did not come to the disk.
void forget_beyond_end(RecordingHeader& header) {
  std::erase_if(header.gaps, [&](const Gap& gap) { return gap.frame > header.frames; });
  std::erase_if(header.marks, [&](const Mark& mark) { return mark.frame > header.frames; });
}

}  // namespace

Result<Recording> close_recording(const std::string& stem, RecordingHeader header, EventFile& events) {
  const std::string wav = stem + ".wav";
  const auto frames = repair_riff(wav);
  if (!frames) return forward_error(frames);
  if (const auto synced = sync_path(wav); !synced) return forward_error(synced);
  header.frames = *frames;
  forget_beyond_end(header);
  header.clock_drift_ppm = drift_ppm(header.clock_pairs);
  thin(header.clock_pairs);
  const auto text = completed_sidecar(header, wav);
  if (!text) return forward_error(text);
  events.release_room();
  PendingFiles pending;
  if (const auto written = pending.write(stem + ".json", *text); !written) return forward_error(written);
  if (const auto committed = pending.commit(); !committed) return forward_error(committed);
  if (const auto synced = sync_path(folder_of(wav)); !synced) return forward_error(synced);
  if (const auto removed = events.remove(); !removed) return forward_error(removed);
  return Recording{std::move(header), stem};
}

}  // namespace tacto::schema
