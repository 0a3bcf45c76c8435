// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spatial/smoothed_speed.hpp"

namespace tacto::spatial {
namespace {

constexpr double kPause_s = 0.1;   // a finger that sticks lets go sooner
constexpr double kSlowest = 0.1;   // of the stroke's own travelling speed: it starts and ends there
constexpr double kUnderWay = 0.5;  // what a stroke reaches somewhere
constexpr double kRest = 0.001;    // of the record's travelling speed: creep of a resting stage
constexpr double kRestQuanta = 3;  // a window: dither of a resting encoder
constexpr double kShortestOfLongest = 0.05;
constexpr double kShortestQuanta = 20;

// A record's positions and what was learnt of them.
struct Track {
  std::span<const double> position_m;
  std::vector<double> speed_mps;
  std::size_t pause = 0;  // samples
  double quantum_m = 0;
  double rest_mps = 0;  // slower is standing still

  double advance(const Stroke& run) const {
    return run.direction * (position_m[run.frames.end - 1] - position_m[run.frames.begin]);
  }
};

std::vector<double> speeds_of(std::span<const double> position_m, double sample_rate_hz, std::size_t window,
                              std::span<const FrameRange> pieces) {
  std::vector<double> speeds(position_m.size(), 0.0);
  for (const FrameRange& piece : pieces) {
    if (piece.size() < 2) continue;
    const auto part = smoothed_speed(position_m.subspan(piece.begin, piece.size()), sample_rate_hz, window);
    std::ranges::copy(part, speeds.begin() + static_cast<std::ptrdiff_t>(piece.begin));
  }
  return speeds;
}

Track track_of(std::span<const double> position_m, double sample_rate_hz,
               std::span<const FrameRange> pieces) {
  Track track{position_m, {}, 0, position_quantum(position_m), 0};
  std::size_t window = speed_window(0, 0, sample_rate_hz);
  track.speed_mps = speeds_of(position_m, sample_rate_hz, window, pieces);
  window = speed_window(track.quantum_m, travelling_speed(track.speed_mps), sample_rate_hz);
  track.speed_mps = speeds_of(position_m, sample_rate_hz, window, pieces);
  const double dither_mps = kRestQuanta * track.quantum_m / static_cast<double>(window) * sample_rate_hz;
  track.rest_mps = std::max(dither_mps, kRest * travelling_speed(track.speed_mps));
  track.pause = static_cast<std::size_t>(std::ceil(kPause_s * sample_rate_hz));
  return track;
}

// Runs within `range` whose speed lies above `threshold_mps`, each in one direction.
std::vector<Stroke> runs_above(const Track& track, FrameRange range, double threshold_mps) {
  std::vector<Stroke> runs;
  int before = 0;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const double speed = track.speed_mps[i];
    const int now = std::abs(speed) > threshold_mps ? (speed > 0 ? 1 : -1) : 0;
    if (now != 0 && now != before) runs.push_back({{i, i}, now});
    if (now != 0) runs.back().frames.end = i + 1;
    before = now;
  }
  return runs;
}

// Joins neighbours in one direction that only a short pause parts.
std::vector<Stroke> joined(const Track& track, const std::vector<Stroke>& runs) {
  std::vector<Stroke> result;
  for (const Stroke& run : runs) {
    const bool goes_on = !result.empty() && result.back().direction == run.direction &&
                         run.frames.begin - result.back().frames.end < track.pause;
    if (goes_on) {
      result.back().frames.end = run.frames.end;
    } else {
      result.push_back(run);
    }
  }
  return result;
}

// The parts of a run that are strokes by the run's own speed.
void append_strokes(const Track& track, const Stroke& run, std::vector<Stroke>& strokes) {
  const auto speeds = std::span(track.speed_mps).subspan(run.frames.begin, run.frames.size());
  const double own_mps = travelling_speed(speeds);
  for (const Stroke& part : joined(track, runs_above(track, run.frames, kSlowest * own_mps))) {
    const auto inside = std::span(track.speed_mps).subspan(part.frames.begin, part.frames.size());
    const auto under_way = [&](double speed) { return part.direction * speed > kUnderWay * own_mps; };
    if (part.direction == run.direction && std::ranges::any_of(inside, under_way)) strokes.push_back(part);
  }
}

// What a finger calls a stroke: not the wobble at rest, nor a settling at an end.
void drop_short(const Track& track, std::vector<Stroke>& runs) {
  double longest_m = 0;
  for (const Stroke& run : runs) longest_m = std::max(longest_m, track.advance(run));
  const double shortest_m = std::max(kShortestOfLongest * longest_m, kShortestQuanta * track.quantum_m);
  std::erase_if(runs, [&](const Stroke& run) { return track.advance(run) < shortest_m; });
}

}  // namespace

std::vector<FrameRange> pieces_between_gaps(std::size_t frames, std::span<const schema::Gap> gaps) {
  std::vector<FrameRange> pieces;
  std::size_t begin = 0;
  for (const schema::Gap& gap : gaps) {
    const std::size_t end = std::min<std::size_t>(gap.frame, frames);
    if (end > begin) pieces.push_back({begin, end});
    begin = std::max(begin, end);
  }
  if (frames > begin) pieces.push_back({begin, frames});
  return pieces;
}

std::vector<Stroke> find_strokes(std::span<const double> position_m, double sample_rate_hz,
                                 std::span<const schema::Gap> gaps) {
  const auto pieces = pieces_between_gaps(position_m.size(), gaps);
  const Track track = track_of(position_m, sample_rate_hz, pieces);
  std::vector<Stroke> strokes;
  for (const FrameRange& piece : pieces) {
    std::vector<Stroke> runs = runs_above(track, piece, track.rest_mps);
    drop_short(track, runs);
    for (const Stroke& run : joined(track, runs)) append_strokes(track, run, strokes);
  }
  drop_short(track, strokes);
  return strokes;
}

double backward_travel(std::span<const double> position_m, int direction) {
  double furthest = -std::numeric_limits<double>::infinity(), backward = 0;
  for (const double position : position_m) {
    furthest = std::max(furthest, direction * position);
    backward = std::max(backward, furthest - direction * position);
  }
  return backward;
}

}  // namespace tacto::spatial
