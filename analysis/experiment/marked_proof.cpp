// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/marked_proof.hpp"

#include <algorithm>
#include <limits>

#include "analysis/experiment/interval_facts.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/session/session_reader.hpp"
#include "playback/session/session_limits.hpp"
#include "playback/session/session_replay.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr std::string_view kEndMark = "end";

// The marks are in the order of their ticks.
std::vector<MarkedInterval> intervals_between(const std::vector<schema::SessionEvent>& marks) {
  std::vector<MarkedInterval> intervals;
  bool open = false;
  for (const schema::SessionEvent& mark : marks) {
    if (open) intervals.back().to_tick = mark.tick;
    open = mark.text != kEndMark;
    if (!open) continue;
    MarkedInterval& begun = intervals.emplace_back();
    begun.mark = mark.text;
    begun.from_tick = mark.tick;
    begun.to_tick = std::numeric_limits<std::uint64_t>::max();
  }
  return intervals;
}

// Finds the interval of each tick, of ticks in order.
class TickOrder {
 public:
  explicit TickOrder(std::vector<MarkedInterval>& intervals) : intervals_(intervals) {}
  MarkedInterval* interval_of(std::uint64_t tick) {
    while (next_ < intervals_.size() && tick >= intervals_[next_].to_tick) ++next_;
    return next_ < intervals_.size() && tick >= intervals_[next_].from_tick ? &intervals_[next_] : nullptr;
  }
  std::size_t index() const { return next_; }

 private:
  std::vector<MarkedInterval>& intervals_;
  std::size_t next_ = 0;
};

// Takes the blocks of a session.
class MarkedCounter {
 public:
  explicit MarkedCounter(std::vector<MarkedInterval>& intervals) : intervals_(intervals), order_(intervals) {}

  void operator()(const std::vector<schema::SessionTick>& ticks) {
    if (first_ns_ == kNoTick) first_ns_ = ticks.front().time_ns;
    stored_to_ = ticks.back().tick + 1;
    for (const schema::SessionTick& tick : ticks) {
      MarkedInterval* const interval = order_.interval_of(tick.tick);
      if (interval == nullptr) continue;
      interval->to_s = 1e-9 * static_cast<double>(tick.time_ns - first_ns_);
      if (interval->facts.ticks == 0) interval->from_s = interval->to_s;
      count_tick(tick, interval->facts);
    }
  }
  void operator()(const schema::SessionLoss& loss) {
    const std::uint64_t end = loss.first_tick + loss.count;
    stored_to_ = std::max(stored_to_, end);
    auto interval = std::ranges::partition_point(
        intervals_, [&](const MarkedInterval& each) { return each.to_tick <= loss.first_tick; });
    for (; interval != intervals_.end() && interval->from_tick < end; ++interval) {
      const std::uint64_t from = std::max(loss.first_tick, interval->from_tick);
      const std::uint64_t to = std::min(end, interval->to_tick);
      if (to > from) interval->facts.lost_ticks += to - from;
    }
  }
  template <class Other>
  void operator()(const Other& /*other*/) const {}
  /// The tick after the last one that is stored, or known as lost.
  std::uint64_t stored_to() const { return stored_to_; }

 private:
  std::uint64_t stored_to_ = 0;
  static constexpr std::int64_t kNoTick = std::numeric_limits<std::int64_t>::min();
  std::vector<MarkedInterval>& intervals_;
  TickOrder order_;
  std::int64_t first_ns_ = kNoTick;
};

// A mark is stored at once, ticks a little later: of a session whose writer was killed, an interval with both
// marks may lack its last ticks.
Result<void> count_ticks(const std::string& name, std::vector<MarkedInterval>& intervals) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  MarkedCounter counter(intervals);
  while (const auto block = reader->next()) std::visit(counter, *block);
  const bool closed = reader->ending() == schema::SessionEnding::closed;
  for (MarkedInterval& interval : intervals)
    interval.facts.closed = closed || interval.to_tick <= counter.stored_to();
  // So that the times rise also over an interval without ticks.
  for (std::size_t i = 1; i < intervals.size(); ++i)
    if (intervals[i].facts.ticks == 0) intervals[i].from_s = intervals[i].to_s = intervals[i - 1].to_s;
  return {};
}

// Of each interval the strokes that are completely in it.
Result<void> judge_strokes(const std::string& name, std::vector<MarkedInterval>& intervals,
                           const std::function<void(double)>& tell) {
  std::vector<std::vector<playback::PlayedStroke>> strokes(intervals.size());
  const auto take = [&](const playback::PlayedStroke& stroke) {
    const auto after = std::ranges::partition_point(
        intervals, [&](const MarkedInterval& each) { return each.to_s < stroke.to_s; });
    if (after == intervals.end() || stroke.from_s < after->from_s) return;
    strokes[static_cast<std::size_t>(after - intervals.begin())].push_back(stroke);
  };
  TACTO_TRY(playback::report_strokes(name, {take, tell}));
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    intervals[i].facts.strokes = strokes[i].size();
    add_strokes(strokes[i], intervals[i].facts);
  }
  return {};
}

Result<void> tally_limits(const std::string& name, std::vector<MarkedInterval>& intervals) {
  std::vector<playback::LimitTally> tallies(intervals.size());
  TickOrder order(intervals);
  const auto each = [&](const schema::SessionTick& tick, std::optional<float> unlimited_v) {
    if (unlimited_v && order.interval_of(tick.tick) != nullptr)
      tallies[order.index()].add(playback::limited_tick(tick.drive_v, *unlimited_v, tick.flags));
  };
  TACTO_TRY(playback::read_unlimited_where_known(name, each));
  for (std::size_t i = 0; i < intervals.size(); ++i)
    if (tallies[i].ticks() == intervals[i].facts.ticks)
      intervals[i].facts.removed_by_limits_db = tallies[i].removed_db();
  return {};
}

void decide(MarkedInterval& interval, const schema::DeliveryLimits& limits) {
  if (!interval.facts.closed) interval.why.emplace_back("session not complete");
  const auto by_limits = reasons_by_limits(interval.facts, limits);
  interval.why.insert(interval.why.end(), by_limits.begin(), by_limits.end());
  interval.delivered = Delivered::no;
  if (!interval.why.empty()) return;
  if (interval.facts.strokes == 0) interval.why.emplace_back("no whole stroke");
  if (interval.facts.strokes > 0 && !interval.facts.predicted_error_db)
    interval.why.emplace_back("error unknown");
  interval.delivered = interval.why.empty() ? Delivered::yes : Delivered::unknown;
}

}  // namespace

bool names_session(const std::string& name) {
  return name.ends_with(".session") ||
         (!schema::is_file(schema::journal_path(name)) && schema::is_file(schema::session_path(name)));
}

Result<MarkedProof> prove_marks(const std::string& name, const schema::DeliveryLimits& limits,
                                const std::function<void(double)>& tell) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  if (reader->header().forces)
    return fail(ErrorKind::unsuitable, "is a session of forces: it has no strokes to judge", reader->path(),
                "'tactograph replay' computes its forces again");
  MarkedProof proof;
  proof.simulated = reader->header().simulated;
  proof.intervals = intervals_between(session_totals(*reader).marks);
  if (proof.intervals.empty())
    return fail(ErrorKind::unsuitable, "has no mark that begins an interval", reader->path(),
                "set marks while it is recorded, for example with 'tactograph ctl mark \"trial 1\"'");
  TACTO_TRY(count_ticks(name, proof.intervals));
  TACTO_TRY(judge_strokes(name, proof.intervals, [&](double part) { tell(part / 2); }));
  TACTO_TRY(tally_limits(name, proof.intervals));
  for (MarkedInterval& interval : proof.intervals) {
    interval.facts.simulated = proof.simulated;
    decide(interval, limits);
  }
  const auto replayed = playback::replay_session(name, [&](double part) { tell((1 + part) / 2); });
  proof.same_to_the_bit = replayed && replayed->same();
  return proof;
}

}  // namespace tacto::analysis
