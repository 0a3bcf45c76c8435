// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/interval_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/experiment/spatial_period.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/session/session_reader.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/strokes/session_stroke.hpp"
#include "playback/strokes/stroke_report.hpp"

namespace tacto::analysis {

using schema::IntervalFacts;
using schema::Result;

namespace {

// Counts the ticks of a session, block by block.
struct TickCounter {
  IntervalFacts& facts;

  void operator()(const std::vector<schema::SessionTick>& ticks) const {
    for (const schema::SessionTick& tick : ticks) count_tick(tick, facts);
  }
  void operator()(const schema::SessionLoss& loss) const { facts.lost_ticks += loss.count; }
  template <class Other>
  void operator()(const Other& /*other*/) const {}
};

// Of the longest stroke.
void add_periods(const std::string& session, IntervalFacts& facts) {
  const auto stroke = playback::read_session_stroke(session, 0);
  if (!stroke) return;
  std::vector<double> position_m;
  for (const playback::SessionRow& row : stroke->rows) position_m.push_back(row.position_m);
  facts.predicted_period_m = spatial_period_m(position_m, stroke->predicted_m);
  if (!stroke->measured_m.empty()) facts.measured_period_m = spatial_period_m(position_m, stroke->measured_m);
}

// By the RMS of the displacement that `rms_m` gives of each stroke. Precondition: each has a target, of one
// texture at this gain.
double gain_by_m_per_n(std::span<const playback::PlayedStroke> strokes, double gain_m_per_n,
                       double (*rms_m)(const playback::PlayedStroke&)) {
  double displacement_m2 = 0, target_m2 = 0;
  for (const playback::PlayedStroke& stroke : strokes) {
    displacement_m2 += rms_m(stroke) * rms_m(stroke);
    target_m2 += stroke.target_rms_m * stroke.target_rms_m;
  }
  return gain_m_per_n * std::sqrt(displacement_m2 / target_m2);
}

void add_count(std::vector<std::string>& why, std::uint64_t count, int limit, const char* what) {
  if (count > static_cast<std::uint64_t>(limit)) why.push_back(fmt::format("{} {}", count, what));
}

void add_level(std::vector<std::string>& why, const std::optional<double>& level_db, double limit_db,
               const char* what) {
  if (!level_db)
    why.push_back(fmt::format("{} unknown", what));
  else if (*level_db > limit_db)
    why.push_back(fmt::format("{} {:.1f} dB", what, *level_db));
}

std::string speed_in_words(double speed_mps) {
  return schema::for_people(speed_mps, schema::Dimension::speed);
}

}  // namespace

void count_tick(const schema::SessionTick& tick, IntervalFacts& facts) {
  constexpr std::uint32_t kBlind = wire::kTickPlaying | wire::kTickBlind;
  ++facts.ticks;
  facts.fault_ticks += (tick.flags & wire::kTickFault) != 0;
  facts.late_ticks += (tick.flags & wire::kTickLate) != 0;
  facts.blind_ticks += (tick.flags & kBlind) == kBlind;
}

void add_strokes(std::span<const playback::PlayedStroke> strokes, IntervalFacts& facts) {
  bool target = !strokes.empty(), sensor = target;
  double predicted_db = -INFINITY, measured_db = -INFINITY;
  for (const playback::PlayedStroke& stroke : strokes) {
    const double speed_mps = std::abs(stroke.to_m - stroke.from_m) / (stroke.to_s - stroke.from_s);
    facts.slowest_mps = facts.slowest_mps > 0 ? std::min(facts.slowest_mps, speed_mps) : speed_mps;
    facts.fastest_mps = std::max(facts.fastest_mps, speed_mps);
    target &= stroke.target_rms_m > 0;
    sensor &= stroke.measured.has_value();
    if (target) predicted_db = std::max(predicted_db, stroke.predicted.error_db);
    if (target && sensor) measured_db = std::max(measured_db, stroke.measured->error_db);
  }
  if (target) facts.predicted_error_db = predicted_db;
  if (target && sensor) facts.measured_error_db = measured_db;
}

Result<double> predicted_rms_m(const std::string& session, std::uint64_t stroke) {
  const auto read = playback::read_session_stroke(session, stroke);
  TACTO_TRY(read);
  double sum = 0;
  for (const double value_m : read->predicted_m) sum += value_m * value_m;
  return std::sqrt(sum / static_cast<double>(read->predicted_m.size()));
}

Result<IntervalFacts> interval_facts(const std::string& session) {
  auto reader = schema::SessionReader::open(session);
  TACTO_TRY(reader);
  IntervalFacts facts;
  while (const auto block = reader->next()) std::visit(TickCounter{facts}, *block);
  facts.closed = reader->ending() == schema::SessionEnding::closed;
  facts.simulated = reader->header().simulated;
  if (reader->header().textures.size() == 1) facts.stimulus_sha256 = reader->header().textures.front().sha256;
  if (const auto report = playback::report_strokes(session)) {
    facts.strokes = report->stroke_count;
    if (report->limits) facts.removed_by_limits_db = report->limits->removed_db();
    add_strokes(report->strokes, facts);
    const schema::SessionHeader& header = reader->header();
    facts.last_gain = report->last_gain;
    if (header.textures.size() == 1 && facts.predicted_error_db) {
      const std::span<const playback::PlayedStroke> all = report->strokes;
      const auto strokes = report->last_gain == header.initial_gain ? all : all.last(1);
      const double gain_m_per_n = report->last_gain * header.textures.front().gain_m_per_n;
      facts.predicted_gain_m_per_n =
          gain_by_m_per_n(strokes, gain_m_per_n, [](const auto& stroke) { return stroke.predicted.rms_m; });
      if (facts.measured_error_db)
        facts.measured_gain_m_per_n =
            gain_by_m_per_n(strokes, gain_m_per_n, [](const auto& stroke) { return stroke.measured->rms_m; });
    }
  }
  if (facts.strokes > 0) add_periods(session, facts);
  return facts;
}

std::vector<std::string> reasons_by_limits(const IntervalFacts& facts, const schema::DeliveryLimits& limits) {
  std::vector<std::string> why;
  add_count(why, facts.lost_ticks, limits.lost_ticks, "lost ticks");
  add_count(why, facts.fault_ticks, limits.fault_ticks, "ticks in fault");
  add_count(why, facts.late_ticks, limits.late_ticks, "late ticks");
  add_count(why, facts.blind_ticks, limits.blind_ticks, "blind ticks");
  add_level(why, facts.removed_by_limits_db, limits.removed_by_limits_db, "removed by limits");
  if (facts.predicted_error_db) add_level(why, facts.predicted_error_db, limits.error_db, "error");
  if (facts.strokes > 0 && facts.slowest_mps < limits.slowest_mps)
    why.push_back("too slow: " + speed_in_words(facts.slowest_mps));
  if (facts.fastest_mps > limits.fastest_mps) why.push_back("too fast: " + speed_in_words(facts.fastest_mps));
  return why;
}

std::vector<std::string> reasons_against(const IntervalFacts& facts, const schema::Protocol& protocol,
                                         const std::string& sha256) {
  std::vector<std::string> why;
  if (!facts.closed) why.emplace_back("session not complete");
  if (facts.stimulus_sha256 != sha256) why.emplace_back("another texture was played");
  const std::vector<std::string> by_limits = reasons_by_limits(facts, protocol.delivered);
  why.insert(why.end(), by_limits.begin(), by_limits.end());
  if (facts.strokes < static_cast<std::uint64_t>(protocol.pace.strokes))
    why.push_back(fmt::format("{} of {} strokes", facts.strokes, protocol.pace.strokes));
  else if (!facts.predicted_error_db)
    why.emplace_back("error unknown");
  return why;
}

namespace {

// Of an ordering: one interval of a stimulus that was delivered is enough, so the others do not count.
bool is_delivered(const std::string& sha256, const std::vector<std::string>& all,
                  const std::vector<std::vector<std::string>>& why) {
  for (std::size_t i = 0; i < why.size(); ++i)
    if (all[i] == sha256 && why[i].empty()) return true;
  return false;
}

}  // namespace

schema::DeliveryJudged judged_delivery(int attempt, std::vector<IntervalFacts> intervals,
                                       const std::vector<std::string>& sha256,
                                       const schema::Protocol& protocol,
                                       const std::vector<std::string>& late_start) {
  schema::DeliveryJudged judged{attempt, false, late_start, {}};
  std::vector<std::vector<std::string>> why;
  for (std::size_t i = 0; i < intervals.size(); ++i)
    why.push_back(reasons_against(intervals[i], protocol, sha256[i]));
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    if (protocol.task == schema::Task::ordering && is_delivered(sha256[i], sha256, why)) continue;
    for (const std::string& reason : why[i])
      judged.why.push_back(fmt::format("interval {}: {}", i + 1, reason));
  }
  judged.delivered = judged.why.empty();
  judged.intervals = std::move(intervals);
  return judged;
}

}  // namespace tacto::analysis
