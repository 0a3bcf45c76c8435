// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/touch_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <ranges>
#include <span>
#include <utility>

#include "data-schema/base/lagrange.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/stroke_rule.hpp"
#include "spatial/strokes/position_jumps.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::array<int, 3> kBits = {16, 24, 32};
constexpr double kStepsOff = 2;    // a finger does not double its speed within a sample
constexpr double kCountsOff = 16;  // dither of a resting encoder, and a start from rest
constexpr double kSmallestJump = 0x1p15;

double turn_of(int bits) {
  return std::ldexp(1.0, bits);
}

bool is_whole(double value) {
  return value == std::round(value);
}

constexpr std::size_t kBeside = 2;  // frames on each side of a gap

struct Bridge {
  std::size_t first = 0;   // in the numbers of the bridged source
  std::size_t count = 0;   // filled frames
  std::size_t stored = 0;  // the frame behind the gap, in the numbers of the recording
  std::array<std::vector<double>, kTracks.size()> values = {};  // by Track

  std::size_t end() const { return first + count; }
};

class BridgedSource : public TouchSource {
 public:
  BridgedSource(std::unique_ptr<TouchSource> stored, std::vector<Bridge> bridges)
      : stored_(std::move(stored)), bridges_(std::move(bridges)) {}

  const schema::Channel* channel(Track track) const override { return stored_->channel(track); }

  Result<void> read_stored(Track track, std::size_t first, std::span<double> out) override {
    const std::size_t end = first + out.size();
    for (std::size_t at = first; at < end;) {
      const auto next = std::ranges::upper_bound(bridges_, at, {}, &Bridge::first);
      const Bridge& before = next == bridges_.begin() ? none_ : *std::prev(next);
      if (at < before.end()) {
        out[at - first] = before.values[static_cast<std::size_t>(track)][at - before.first];
        ++at;
        continue;
      }
      const std::size_t until = next == bridges_.end() ? end : std::min(end, next->first);
      const std::size_t stored = at - before.end() + before.stored;
      TACTO_TRY(stored_->read_stored(track, stored, out.subspan(at - first, until - at)));
      at = until;
    }
    return {};
  }

 private:
  std::unique_ptr<TouchSource> stored_;
  std::vector<Bridge> bridges_;
  const Bridge none_ = {};
};

Result<Bridge> filled(TouchSource& source, const schema::Gap& gap, std::size_t before) {
  Bridge bridge{gap.frame + before, gap.count, gap.frame};
  const auto missing = static_cast<double>(gap.count);
  for (const Track track : kTracks) {
    if (source.channel(track) == nullptr) continue;
    std::array<double, 2 * kBeside> y{};
    TACTO_TRY(source.read_stored(track, gap.frame - kBeside, y));
    for (std::size_t i = 1; i <= gap.count; ++i) {
      const auto x = static_cast<double>(i);
      bridge.values[static_cast<std::size_t>(track)].push_back(
          track == Track::position || track == Track::normal_force
              ? std::lerp(y[1], y[2], x / (missing + 1))
              : schema::lagrange({-1, 0, missing + 1, missing + 2}, y, x));
    }
  }
  return bridge;
}

double across_s(const schema::Gap& gap, double sample_rate_hz) {
  return static_cast<double>(gap.count + 1) / sample_rate_hz;
}

bool can_be_filled(const schema::RecordingHeader& header, std::size_t i) {
  constexpr double kRounding = 1 + 1e-9;
  const schema::Gap& gap = header.gaps[i];
  const std::uint64_t from = i == 0 ? 0 : header.gaps[i - 1].frame;
  const std::uint64_t to = i + 1 == header.gaps.size() ? header.frames : header.gaps[i + 1].frame;
  return gap.count <= kMostFilledFrames &&
         across_s(gap, header.sample_rate_hz) <= kRounding * kLongestFilled_s &&
         from + kBeside <= gap.frame && gap.frame + kBeside <= to;
}

Result<bool> moves_as_a_finger(TouchSource& source, const schema::Gap& gap, double sample_rate_hz) {
  std::array<double, 2> position_m{};
  TACTO_TRY(source.read(Track::position, gap.frame - 1, position_m));
  return std::abs(position_m[1] - position_m[0]) <= kFastestFinger_mps * across_s(gap, sample_rate_hz);
}

constexpr std::size_t kShortFrames = 1000000;

// The largest movement back in a section that still counts as one direction: a few counts, or the finger's
// elastic rebound.
constexpr double kBackwardQuanta = 4;
constexpr double kBackwardSigmas = 10;  // noise between the largest and the smallest of 1e6 values
constexpr double kBackwardOfWay = 0.002;
// A shorter movement is dither, or the creep of a resting finger.
constexpr double kShortestTravelResolutions = 20;
// A frame includes half a sample period on each side, so that a time with few digits still selects it.
constexpr double kWithinFrame = 0.5;

// The pieces without the frames that were filled; both are sorted.
std::vector<FrameRange> without(std::span<const FrameRange> pieces, std::span<const FrameRange> filled) {
  std::vector<FrameRange> measured;
  auto next = filled.begin();
  for (FrameRange piece : pieces) {
    for (; next != filled.end() && next->begin < piece.end; ++next) {
      measured.push_back({piece.begin, next->begin});
      piece.begin = next->end;
    }
    measured.push_back(piece);
  }
  return measured;
}

std::string seconds(double s) {
  return fmt::format("{:.4g} s", s);
}

}  // namespace

double finger_up_below_n(std::span<const Stroke> strokes) {
  double hardest_n = 0;
  for (const Stroke& stroke : strokes) hardest_n = std::max(hardest_n, stroke.force_n.value_or(0));
  return std::max(kLightestTouch_n, kUpShareOfHardest * hardest_n);
}

std::string why_finger_up(double threshold_n) {
  return schema::for_people(threshold_n, schema::Dimension::force) +
         (threshold_n > kLightestTouch_n ? ", a tenth of the largest mean force of a stroke"
                                         : ", the least force of a touch");
}

void CounterWraps::unwrap(std::size_t first, std::span<double> counts) const {
  if (bits == 0) return;
  auto next = std::ranges::upper_bound(turns, first, {}, &CounterTurn::frame);
  double added = next == turns.begin() ? 0 : std::prev(next)->turns * turn_of(bits);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    for (; next != turns.end() && next->frame <= first + i; ++next) added = next->turns * turn_of(bits);
    counts[i] += added;
  }
}

std::size_t CounterWraps::count_in(std::size_t begin, std::size_t end) const {
  const auto first = std::ranges::upper_bound(turns, begin, {}, &CounterTurn::frame);
  const auto last = std::ranges::lower_bound(first, turns.end(), end, {}, &CounterTurn::frame);
  return static_cast<std::size_t>(last - first);
}

std::uint64_t CounterWrapFinder::missing_before(std::size_t frame) const {
  std::uint64_t missing = 0;
  for (const schema::Gap& gap : std::ranges::equal_range(gaps_, frame, {}, &schema::Gap::frame))
    missing += gap.count;
  return missing;
}

void CounterWrapFinder::judge(double before, double step, double after, std::size_t frame) {
  const double around = std::max(std::abs(before), std::abs(after));
  const double off = kStepsOff * around * static_cast<double>(1 + missing_before(frame)) + kCountsOff;
  for (std::size_t b = 0; b < kBits.size(); ++b) {
    const double turn = turn_of(kBits[b]), missed = std::abs(step) - turn;
    if (std::abs(missed) > std::min(off, turn / 4) || !is_whole(step)) continue;
    auto& turns = found_[b];
    const int so_far = turns.empty() ? 0 : turns.back().turns;
    turns.push_back({frame, so_far + (step < 0 ? 1 : -1)});
  }
}

void CounterWrapFinder::add(std::span<const double> counts) {
  for (const double value : counts) {
    if (frames_ == 0) lowest_ = highest_ = value_ = value;
    const double step = value - value_;
    if (std::abs(step_) > kSmallestJump) judge(step_before_, step_, step, frames_ - 1);
    lowest_ = std::min(lowest_, value);
    highest_ = std::max(highest_, value);
    step_before_ = std::exchange(step_, step);
    value_ = value;
    ++frames_;
  }
}

CounterWraps CounterWrapFinder::finish() {
  if (std::abs(step_) > kSmallestJump) judge(step_before_, step_, 0, frames_ - 1);
  for (std::size_t b = 0; b < kBits.size(); ++b)
    if (!found_[b].empty() && highest_ - lowest_ < turn_of(kBits[b])) return {kBits[b], found_[b]};
  return {};
}

Result<BridgedTouch> bridge_short_gaps(std::unique_ptr<TouchSource> source, schema::RecordingHeader header) {
  std::vector<Bridge> bridges;
  std::vector<FrameRange> ranges;
  std::vector<schema::Gap> left;
  std::size_t before = 0;
  for (std::size_t i = 0; i < header.gaps.size(); ++i) {
    const schema::Gap& gap = header.gaps[i];
    bool bridged = can_be_filled(header, i);
    if (bridged) {
      const auto moves = moves_as_a_finger(*source, gap, header.sample_rate_hz);
      TACTO_TRY(moves);
      bridged = *moves;
    }
    if (!bridged) {
      left.push_back({gap.frame + before, gap.device_sequence, gap.count});
      continue;
    }
    auto bridge = filled(*source, gap, before);
    TACTO_TRY(bridge);
    ranges.push_back({bridge->first, bridge->end()});
    before += gap.count;
    bridges.push_back(std::move(*bridge));
  }
  if (bridges.empty()) return BridgedTouch{std::move(source), std::move(header), {}};
  header.frames += before;
  header.gaps = std::move(left);
  return BridgedTouch{std::make_unique<BridgedSource>(std::move(source), std::move(bridges)),
                      std::move(header), std::move(ranges)};
}

schema::Result<PositionTrack> PositionTrack::open(TouchSource& source, std::size_t frames,
                                                  std::span<const schema::Gap> gaps) {
  PositionTrack track(source);
  const bool is_kept = frames <= kShortFrames;
  CounterWrapFinder finder(gaps);
  std::vector<double> stored(is_kept ? frames : kChunkFrames);
  const auto add = [&](FrameRange part) -> schema::Result<void> {
    const auto counts = std::span(stored).subspan(is_kept ? part.begin : 0, part.size());
    TACTO_TRY(source.read_stored(Track::position, part.begin, counts));
    finder.add(counts);
    return {};
  };
  TACTO_TRY(chunk_by_chunk({0, frames}, add));
  const schema::Channel& properties = *source.channel(Track::position);
  const double counts = std::max(std::abs(finder.lowest()), std::abs(finder.highest()));
  track.furthest_m_ = counts * std::abs(properties.scale) + std::abs(properties.offset);
  track.moves_ = finder.lowest() < finder.highest() && properties.scale != 0;
  track.wraps_ = finder.finish();
  if (!is_kept) return track;
  track.to_metres(0, stored);
  track.kept_m_ = std::move(stored);
  return track;
}

void PositionTrack::to_metres(std::size_t first, std::span<double> counts) const {
  wraps_.unwrap(first, counts);
  const schema::Channel& properties = *source_->channel(Track::position);
  for (double& value : counts) value = properties.physical(value);
}

schema::Result<void> PositionTrack::read(std::size_t first, std::span<double> out) const {
  if (!kept_m_.empty()) {
    std::ranges::copy(std::span(kept_m_).subspan(first, out.size()), out.begin());
    return {};
  }
  TACTO_TRY(source_->read_stored(Track::position, first, out));
  to_metres(first, out);
  return {};
}

schema::Result<std::vector<double>> PositionTrack::read(FrameRange frames) const {
  std::vector<double> positions(frames.size());
  TACTO_TRY(read(frames.begin, positions));
  return positions;
}

schema::Result<TouchRecord> TouchRecord::open(const schema::Recording& recording,
                                              const std::string& channel) {
  auto source = open_touch_source(recording, channel);
  TACTO_TRY(source);
  return open(std::move(*source), recording.header, recording.stem);
}

schema::Result<TouchRecord> TouchRecord::open(std::unique_ptr<TouchSource> source,
                                              schema::RecordingHeader header, std::string where) {
  TouchRecord record;
  auto bridged = bridge_short_gaps(std::move(source), std::move(header));
  TACTO_TRY(bridged);
  record.header_ = std::move(bridged->header);
  record.where_ = std::move(where);
  record.source_ = std::move(bridged->source);
  record.filled_ = std::move(bridged->filled);
  TACTO_TRY(record.survey());
  return record;
}

schema::Result<void> TouchRecord::survey() {
  auto track = PositionTrack::open(*source_, header_.frames, header_.gaps);
  TACTO_TRY(track);
  track_ = std::move(*track);
  if (!track_->moves())
    return schema::fail(ErrorKind::unsuitable, "the position does not change", where_,
                        "a texture needs a moving finger; check that this is the right position channel");
  pieces_ = pieces_between_gaps(header_.frames, header_.gaps);
  const ReadFrames read = [this](std::size_t first, std::span<double> out) {
    return track_->read(first, out);
  };
  auto jumps = find_position_jumps(read, pieces_, header_.sample_rate_hz);
  TACTO_TRY(jumps);
  jumps_ = std::move(*jumps);
  const auto sound = pieces_between_jumps(pieces_, jumps_);
  const auto measured = pieces_between_jumps(without(pieces_, filled_), jumps_);
  auto facts = spatial::position_facts(read, measured, header_.sample_rate_hz, track_->furthest_m());
  TACTO_TRY(facts);
  facts_ = *facts;
  auto strokes = find_strokes(read, sound, header_.sample_rate_hz, facts_);
  TACTO_TRY(strokes);
  strokes_ = std::move(strokes->strokes);
  short_runs_ = strokes->short_runs;
  longest_m_ = strokes->longest_m;
  mark_cut_strokes();
  if (source_->channel(Track::normal_force) == nullptr) return {};
  for (Stroke& stroke : strokes_)
    if (auto done = weigh(stroke); !done) return done;
  up_below_n_ = spatial::finger_up_below_n(strokes_);
  for (Stroke& stroke : strokes_) stroke.finger_up = stroke.force_n < *up_below_n_;
  return {};
}

// Marks strokes that begin or end near a jump of the position: the finger moved on there, so they are not
// complete.
void TouchRecord::mark_cut_strokes() {
  const auto near = static_cast<std::size_t>(schema::kStrokePause_s * header_.sample_rate_hz) + 1;
  for (Stroke& stroke : strokes_)
    for (const PositionJump& jump : jumps_)
      if (jump.frame + near > stroke.frames.begin && jump.frame < stroke.frames.end + near)
        stroke.jump = jump;
}

schema::Error TouchRecord::refusal(const PositionJump& jump) const {
  return {ErrorKind::unsuitable,
          fmt::format("the position jumps by {} from sample {} to sample {}, at {}: too fast for a finger",
                      schema::length_for_people(jump.step_m), stored_frame(jump.frame) - 1,
                      stored_frame(jump.frame), seconds(schema::frame_time_s(header_, jump.frame))),
          where_, "check the encoder and its cable; select the part before or after with --from and --to"};
}

// Sets the stroke's mean normal force.
schema::Result<void> TouchRecord::weigh(Stroke& stroke) const {
  if (source_->channel(Track::normal_force) == nullptr) return {};
  double sum_n = 0;
  std::vector<double> chunk;
  const auto add = [&](FrameRange part) -> schema::Result<void> {
    chunk.resize(part.size());
    if (auto done = source_->read(Track::normal_force, part.begin, chunk); !done) return done;
    sum_n = std::accumulate(chunk.begin(), chunk.end(), sum_n);
    return {};
  };
  if (auto done = chunk_by_chunk(stroke.frames, add); !done) return done;
  stroke.force_n = sum_n / static_cast<double>(stroke.frames.size());
  return {};
}

std::size_t TouchRecord::filled_in(FrameRange frames) const {
  std::size_t count = 0;
  for (const FrameRange& range : filled_) {
    const std::size_t begin = std::max(range.begin, frames.begin), end = std::min(range.end, frames.end);
    if (begin < end) count += end - begin;
  }
  return count;
}

double TouchRecord::from_s(const Stroke& stroke) const {
  return schema::frame_time_s(header_, stroke.frames.begin);
}

double TouchRecord::to_s(const Stroke& stroke) const {
  return schema::frame_time_s(header_, stroke.frames.end - 1);
}

double TouchRecord::length_m(const Stroke& stroke) const {
  return std::abs(stroke.to_m - stroke.from_m);
}

double TouchRecord::mean_speed_mps(const Stroke& stroke) const {
  return length_m(stroke) / (to_s(stroke) - from_s(stroke));
}

std::string TouchRecord::list_of_strokes() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < strokes_.size(); ++i)
    lines.push_back(
        fmt::format("{}: {} to {}", i + 1, seconds(from_s(strokes_[i])), seconds(to_s(strokes_[i]))));
  return lines.empty() ? "no stroke was found" : fmt::format("the strokes are {}", fmt::join(lines, ", "));
}

schema::Result<Stroke> TouchRecord::stroke(int number) const {
  if (number >= 1 && static_cast<std::size_t>(number) <= strokes_.size())
    return strokes_[static_cast<std::size_t>(number) - 1];
  return schema::fail(ErrorKind::unsuitable, fmt::format("there is no stroke {}", number), where_,
                      list_of_strokes());
}

schema::Result<FrameRange> TouchRecord::frames_between(double from_s, double to_s) const {
  const std::size_t frames = header_.frames;
  const double slack_s = kWithinFrame / header_.sample_rate_hz;
  const double first_s = schema::frame_time_s(header_, 0), last_s = schema::frame_time_s(header_, frames - 1);
  if (!(from_s < to_s))
    return schema::fail(ErrorKind::usage,
                        fmt::format("the time range ends at {}, which is not after its start at {}",
                                    seconds(to_s), seconds(from_s)),
                        where_);
  if (from_s < first_s - slack_s || to_s > last_s + 3 * slack_s)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("the time range {} to {} is not within the recording", seconds(from_s), seconds(to_s)),
        where_, fmt::format("the recording is from {} to {}", seconds(first_s), seconds(last_s)));
  const auto first_from = [&](double time_s) {
    const auto frame_numbers = std::views::iota(std::size_t{0}, frames);
    const auto time_of = [&](std::size_t frame) { return schema::frame_time_s(header_, frame); };
    return *std::ranges::lower_bound(frame_numbers, time_s, {}, time_of);
  };
  return FrameRange{first_from(from_s - slack_s), first_from(to_s + slack_s)};
}

schema::Result<void> TouchRecord::check_gapless(FrameRange frames) const {
  for (const schema::Gap& gap : header_.gaps)
    if (gap.frame > frames.begin && gap.frame < frames.end)
      return schema::fail(ErrorKind::unsuitable,
                          fmt::format("{} frames are missing at {}, inside the time range", gap.count,
                                      seconds(schema::frame_time_s(header_, gap.frame))),
                          where_, "select a time range before or after them");
  return {};
}

schema::Result<Stroke> TouchRecord::directed(FrameRange frames) const {
  const auto read = position_m(frames);
  TACTO_TRY(read);
  const std::vector<double>& positions = *read;
  if (positions.size() < 2 || positions.front() == positions.back())
    return schema::fail(ErrorKind::unsuitable, "the finger does not advance in the time range", where_,
                        list_of_strokes());
  const double advance_m = std::abs(positions.back() - positions.front());
  const int direction = positions.back() > positions.front() ? 1 : -1;
  const double backward_m = backward_travel(positions, direction);
  const double unseen_m = std::max(kBackwardQuanta * facts_.quantum_m, kBackwardSigmas * facts_.noise_m);
  if (backward_m > std::max(unseen_m, kBackwardOfWay * advance_m))
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("the finger reverses in the time range, by {}", schema::length_for_people(backward_m)),
        where_, list_of_strokes());
  if (advance_m < kShortestTravelResolutions * facts_.resolution_m())
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format(
            "the finger hardly moves in the time range: by {}, and the resolution of its position is {}",
            schema::length_for_people(advance_m), schema::length_for_people(facts_.resolution_m())),
        where_, list_of_strokes());
  Stroke stroke{frames, direction, positions.front(), positions.back(), {}, false};
  TACTO_TRY(weigh(stroke));
  stroke.finger_up = up_below_n_ && stroke.force_n < *up_below_n_;
  return stroke;
}

schema::Result<void> TouchRecord::check_jumpless(FrameRange frames) const {
  for (const PositionJump& jump : jumps_)
    if (jump.frame > frames.begin && jump.frame < frames.end) return tl::unexpected(refusal(jump));
  return {};
}

schema::Result<Stroke> TouchRecord::section(double from_s, double to_s) const {
  const auto frames = frames_between(from_s, to_s);
  TACTO_TRY(frames);
  TACTO_TRY(check_gapless(*frames));
  TACTO_TRY(check_jumpless(*frames));
  return directed(*frames);
}

}  // namespace tacto::spatial
