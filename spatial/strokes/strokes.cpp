// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/strokes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "data-schema/base/stroke_rule.hpp"
#include "spatial/strokes/smoothed_speed.hpp"

namespace tacto::spatial {
namespace {

constexpr double kSlowest = 0.1;             // of the stroke's own travelling speed: it starts and ends there
constexpr double kReachedShare = 0.5;        // share of it that a stroke reaches at least once
constexpr double kRest = 1e-4;               // of the record's travelling speed: creep of a resting stage
constexpr double kRestResolutions = 3;       // per window: dither of a resting encoder, 5 sigma of noise
constexpr double kSlowestFinger_mps = 1e-3;  // the slowest speed that the longer window searches for
constexpr double kShortestResolutions = 20;
constexpr double kShortestRun = 3;  // resolutions: longer than dither, shorter than a slip between two sticks
constexpr double kReboundShare = 0.05;  // of the distance before or after: a rebound, not a reversal

using Strokes = std::vector<Stroke>;

double longest_of(const Strokes& strokes) {
  double longest_m = 0;
  for (const Stroke& stroke : strokes) longest_m = std::max(longest_m, stroke.advance_m());
  return longest_m;
}

// A section without gaps, searched with one window.
class Search {
 public:
  Search(const ReadFrames& read, FrameRange section, double sample_rate_hz, const PositionFacts& facts,
         std::size_t window)
      : read_(read), section_(section), rate_hz_(sample_rate_hz), facts_(facts), window_(window) {}

  double rest_mps() const {
    const double dither_mps =
        kRestResolutions * facts_.resolution_m() / static_cast<double>(window_) * rate_hz_;
    return std::max(dither_mps, kRest * facts_.travelling_mps);
  }
  schema::Result<Strokes> strokes() const {
    auto runs = runs_above(section_, rest_mps(), shortest_run_m(), nullptr);
    if (!runs) return runs;
    Strokes strokes = joined(*runs);
    const double shortest = schema::kShortestOfLongest * longest_of(strokes);
    std::erase_if(strokes, [&](const Stroke& run) { return run.advance_m() < shortest; });
    Strokes found;
    for (const Stroke& run : strokes) TACTO_TRY(append_strokes(run, found));
    return found;
  }

 private:
  std::size_t pause() const { return static_cast<std::size_t>(std::ceil(schema::kStrokePause_s * rate_hz_)); }
  double shortest_run_m() const { return kShortestRun * facts_.resolution_m(); }
  // Runs in `range` with a speed above the threshold, each in one direction and at least `shortest_m` long,
  // and the largest speed of each.
  schema::Result<Strokes> runs_above(FrameRange range, double threshold_mps, double shortest_m,
                                     std::vector<double>* fastest_mps) const {
    Strokes runs;
    std::vector<double> fastest;
    const auto end_run = [&] {
      if (runs.empty() || runs.back().advance_m() >= shortest_m) return;
      runs.pop_back();
      fastest.pop_back();
    };
    int before = 0;
    const auto visit = [&](std::size_t frame, double speed_mps, double position_m) {
      const int now = std::abs(speed_mps) > threshold_mps ? (speed_mps > 0 ? 1 : -1) : 0;
      if (now != before && before != 0) end_run();
      if (now != 0 && now != before) {
        runs.push_back({{frame, frame}, now, position_m, position_m, {}, false});
        fastest.push_back(0);
      }
      before = now;
      if (now == 0) return;
      runs.back().frames.end = frame + 1;
      runs.back().to_m = position_m;
      fastest.back() = std::max(fastest.back(), std::abs(speed_mps));
    };
    TACTO_TRY(visit_speeds(read_, section_, range, rate_hz_, window_, visit));
    if (before != 0) end_run();
    if (fastest_mps != nullptr) *fastest_mps = std::move(fastest);
    return runs;
  }

  Strokes joined(const Strokes& runs) const {
    Strokes result;
    for (const Stroke& run : runs) {
      const std::size_t n = result.size();
      const bool back =
          n >= 2 && goes_on(result, n - 2, run) &&
          result[n - 1].advance_m() < kReboundShare * std::max(result[n - 2].advance_m(), run.advance_m());
      if (back) result.pop_back();
      if (back || (n >= 1 && goes_on(result, n - 1, run))) {
        result.back().frames.end = run.frames.end;
        result.back().to_m = run.to_m;
      } else {
        result.push_back(run);
      }
    }
    return result;
  }

  // Whether a run continues the i-th stroke, after a pause or after a short movement back.
  bool goes_on(const Strokes& strokes, std::size_t i, const Stroke& run) const {
    return strokes[i].direction == run.direction && run.frames.begin - strokes[i].frames.end < pause();
  }

  schema::Result<double> own_speed(FrameRange range) const {
    LogHistogram speeds;
    const auto count = [&](std::size_t, double speed_mps, double) { speeds.add(std::abs(speed_mps)); };
    TACTO_TRY(visit_speeds(read_, section_, range, rate_hz_, window_, count));
    return speeds.median_by_sum();
  }

  // The parts of a run that are strokes, by thresholds from the run's own speed.
  schema::Result<void> append_strokes(const Stroke& run, Strokes& strokes) const {
    const auto own_mps = own_speed(run.frames);
    TACTO_TRY(own_mps);
    std::vector<double> fastest_mps;
    auto parts = runs_above(run.frames, kSlowest * *own_mps, facts_.resolution_m(), &fastest_mps);
    TACTO_TRY(parts);
    const Strokes all = joined(*parts);
    std::size_t p = 0;
    for (const Stroke& part : all) {
      double fastest = 0;
      for (; p < parts->size() && (*parts)[p].frames.end <= part.frames.end; ++p)
        if ((*parts)[p].direction == part.direction) fastest = std::max(fastest, fastest_mps[p]);
      if (part.direction == run.direction && fastest > kReachedShare * *own_mps) strokes.push_back(part);
    }
    return {};
  }

  const ReadFrames& read_;
  FrameRange section_;
  double rate_hz_;
  const PositionFacts& facts_;
  std::size_t window_;
};

// The parts of a section between its strokes, a pause away from them.
std::vector<FrameRange> between(FrameRange section, const Strokes& strokes, std::size_t pause) {
  std::vector<FrameRange> rest;
  std::size_t begin = section.begin;
  for (const Stroke& stroke : strokes) {
    if (stroke.frames.begin > begin + 2 * pause) rest.push_back({begin, stroke.frames.begin - pause});
    begin = stroke.frames.end + pause;
  }
  if (section.end > begin + pause) rest.push_back({begin, section.end});
  return rest;
}

// Searches with the window for the record's travelling speed. If a slow finger is not visible with it, the
// parts between strokes are searched again with a longer window.
schema::Result<Strokes> strokes_in(const ReadFrames& read, FrameRange piece, double sample_rate_hz,
                                   const PositionFacts& facts) {
  const double resolution_m = facts.resolution_m();
  const std::size_t window = speed_window(resolution_m, facts.travelling_mps, sample_rate_hz);
  const std::size_t longer = speed_window(resolution_m, kSlowestFinger_mps, sample_rate_hz);
  const Search search(read, piece, sample_rate_hz, facts, window);
  auto strokes = search.strokes();
  if (!strokes || search.rest_mps() < kSlowestFinger_mps / 2 || longer <= window) return strokes;
  const auto pause = static_cast<std::size_t>(std::ceil(schema::kStrokePause_s * sample_rate_hz));
  for (const FrameRange& rest : between(piece, *strokes, pause)) {
    const auto more = Search(read, rest, sample_rate_hz, facts, longer).strokes();
    if (!more) return more;
    strokes->insert(strokes->end(), more->begin(), more->end());
  }
  std::ranges::sort(*strokes, {}, [](const Stroke& stroke) { return stroke.frames.begin; });
  return strokes;
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

schema::Result<FoundStrokes> find_strokes(const ReadFrames& read, std::span<const FrameRange> pieces,
                                          double sample_rate_hz, const PositionFacts& facts) {
  Strokes strokes;
  for (const FrameRange& piece : pieces) {
    if (piece.size() < 2) continue;
    const auto found = strokes_in(read, piece, sample_rate_hz, facts);
    TACTO_TRY(found);
    strokes.insert(strokes.end(), found->begin(), found->end());
  }
  const auto drop_below = [&](double shortest_m) {
    return std::erase_if(strokes, [&](const Stroke& stroke) { return stroke.advance_m() < shortest_m; });
  };
  drop_below(kShortestResolutions * facts.resolution_m());
  const double longest_m = longest_of(strokes);
  const std::size_t short_runs =
      drop_below(std::max(schema::kShortestStroke_m, schema::kShortestOfLongest * longest_m));
  return FoundStrokes{std::move(strokes), short_runs, longest_m};
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
