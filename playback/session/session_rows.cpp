// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/session_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <variant>

#include "firmware-host/core/firmware/encoder_watch.hpp"
#include "firmware-host/core/kernel/counts_between.hpp"
#include "firmware-host/core/kernel/profile.hpp"
#include "firmware-host/core/wire/host_messages.hpp"
#include "playback/session/session_board.hpp"
#include "playback/session/upload_watch.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using schema::SessionTick;

constexpr std::uint64_t kMostColumnTicks = std::uint64_t{1} << 24;

void add_row(SessionColumns& columns, const SessionRow& row) {
  columns.tick.push_back(row.tick);
  columns.position_m.push_back(row.position_m);
  columns.drive_v.push_back(row.drive_v);
}

constexpr std::uint32_t kPlaysBlind = wire::kTickBlind | wire::kTickPlaying;
constexpr std::size_t kMostTexturesKept = 65536;  // of all changes; a file may name any number

// Collects the steering commands in order.
class SteeringSteps {
 public:
  SteeringSteps(double textures_gain, double rate_hz) : textures_gain_(textures_gain), rate_hz_(rate_hz) {}

  void see(const schema::SessionCommand& command) {
    if (!is_frame(command.frame)) return;
    if (const auto begin = message_in_frame<wire::ProfileBegin>(command.frame))
      next_reach_ = reach_of(*begin);
    const auto type = static_cast<wire::MessageType>(command.frame[3]);
    if (armed_ && wire::steers(type)) steps_.push_back({factor_of(command), turn_of(command)});
    if (const auto tracking = message_in_frame<wire::Tracking>(command.frame); tracking && !armed_)
      look_ahead_ticks_ = tracking->look_ahead_ticks;
    if (const auto limits = message_in_frame<wire::Limits>(command.frame); limits && !armed_)
      limits_ = *limits;
    if (!armed_) reach_ = next_reach_;
    armed_ = armed_ || type == wire::MessageType::arm;
  }
  void see(const schema::SessionChange& change) { next_ = change.program; }
  std::vector<SteeringStep> take() { return std::move(steps_); }
  double look_ahead_ticks() const { return look_ahead_ticks_; }
  const ProfileReach& reach() const { return reach_; }
  const wire::Limits& limits() const { return limits_; }

 private:
  static ProfileReach reach_of(const wire::ProfileBegin& begin) {
    core::ProfileScale scale;
    scale.samples_per_count_q32 = begin.samples_per_count_q32;
    return {begin.origin_count, core::reach_counts(scale)};
  }
  std::optional<double> factor_of(const schema::SessionCommand& command) const {
    const auto gain = message_in_frame<wire::Gain>(command.frame);
    return gain ? std::optional(gain->gain / textures_gain_) : std::nullopt;
  }
  std::optional<TextureChange> turn_of(const schema::SessionCommand& command) {
    const auto change = message_in_frame<wire::Change>(command.frame);
    if (!change) return std::nullopt;
    TextureChange turn{0, change->fade_s * rate_hz_, std::exchange(next_, std::nullopt), 0, next_reach_};
    textures_ += turn.brings ? turn.brings->textures.size() : 0;
    if (textures_ > kMostTexturesKept) turn.brings.reset();
    return turn;
  }

  double textures_gain_, rate_hz_, look_ahead_ticks_ = 0;
  wire::Limits limits_{};
  bool armed_ = false;
  ProfileReach reach_, next_reach_;
  std::vector<SteeringStep> steps_;
  std::optional<schema::SessionProgram> next_;  // the textures of the next change
  std::size_t textures_ = 0;
};

// The device has the greatest of the textures' gains; the others are relative to it.
double shared_gain(const schema::SessionHeader& header) {
  double most = 0;
  for (const schema::SessionTexture& texture : header.textures)
    most = std::max(most, std::abs(texture.gain_m_per_n));
  return most == 0 ? 1 : most;
}

// Number of periods without a tick. Times in a message are extrapolated by the rate, so half a period is not
// a gap.
std::uint64_t periods_between(double from_s, double to_s, double rate_hz) {
  const double periods = (to_s - from_s) * rate_hz;
  return periods > 1.5 ? static_cast<std::uint64_t>(std::min(std::round(periods) - 1, 1e15)) : 0;
}

std::uint64_t longest_gap(double rate_hz) {
  return static_cast<std::uint64_t>(core::kBlindS * rate_hz);
}

double seconds_since(std::int64_t first_ns, std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns - first_ns);
}

// Reads the blocks, one overload for each type.
class Surveyor {
 public:
  Surveyor(const schema::SessionHeader& header, SessionOverview& overview)
      : seen_(overview), steps_(shared_gain(header), header.rate_hz) {
    seen_.header = header;
  }
  void operator()(const schema::SessionLoss& loss) { reported_lost_ += loss.count; }
  void operator()(const schema::SessionEnd& end) { reported_lost_ = end.lost_ticks; }
  void operator()(const schema::SessionCommand& command) {
    steps_.see(command);
    upload_.see(command);
  }
  void operator()(const schema::SessionChange& change) { steps_.see(change); }
  void operator()(const schema::SessionEvent&) {}
  void operator()(const schema::SessionSamples&) {}
  void operator()(const std::vector<SessionTick>& ticks) {
    if (seen_.ticks == 0) first_ns_ = last_ns_ = ticks.front().time_ns;
    count_lost_before(ticks.front().tick);
    for (const SessionTick& tick : ticks) count_missing_before(tick);
    seen_.ticks += ticks.size();
    next_tick_ = ticks.back().tick + 1;
  }
  void finish() {
    if (reported_lost_ > seen_.lost && !seen_.lost_at) seen_.lost_at = next_tick_;
    seen_.lost = std::max(seen_.lost, reported_lost_);
    seen_.look_ahead_ticks = steps_.look_ahead_ticks();
    seen_.onset_s = steps_.limits().onset_s, seen_.release_s = steps_.limits().release_s;
    seen_.reach = steps_.reach();
    seen_.steps = steps_.take();
    seen_.not_uploaded = upload_.missing();
  }

 private:
  void count_lost_before(std::uint64_t tick) {
    if (tick <= next_tick_) return;
    if (!seen_.lost_at) seen_.lost_at = next_tick_;
    seen_.lost += tick - next_tick_;
  }
  void count_missing_before(const SessionTick& tick) {
    const double rate_hz = seen_.header.rate_hz;
    const auto missing =
        periods_between(seconds_since(first_ns_, last_ns_), seconds_since(first_ns_, tick.time_ns), rate_hz);
    last_ns_ = tick.time_ns;
    seen_.missing_periods += missing;
    seen_.stops += missing > longest_gap(rate_hz);
    seen_.blind_ticks += (tick.flags & kPlaysBlind) == kPlaysBlind;
  }

  SessionOverview& seen_;
  SteeringSteps steps_;
  UploadWatch upload_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::uint64_t reported_lost_ = 0, next_tick_ = 0;
};

}  // namespace

Result<SessionColumns> read_session_columns(const std::string& name) {
  const auto overview = session_overview(name);
  TACTO_TRY(overview);
  if (overview->ticks > kMostColumnTicks)
    return fail(ErrorKind::unsuitable, fmt::format("has more than {} ticks", kMostColumnTicks),
                overview->path, "`tactograph session` judges and exports sessions of any length");
  SessionColumns columns;
  columns.header = overview->header;
  columns.lost_at = overview->lost_at;
  columns.lost = overview->lost;
  RowMaker maker(*overview);
  const auto read = read_rows(maker, name, [&](const SessionRow& row) { add_row(columns, row); });
  TACTO_TRY(read);
  return columns;
}

bool ProfileReach::holds(std::int32_t encoder) const {
  const std::int64_t away = core::counts_between(origin_count, encoder);
  return away <= counts && away >= -counts;
}

double part_read(const schema::SessionReader& reader) {
  std::error_code ignored;
  const auto size = static_cast<double>(std::filesystem::file_size(reader.path(), ignored));
  return std::min(1.0, static_cast<double>(reader.sound_bytes()) / std::max(size, 1.0));
}

std::function<void(double)> part_of(const std::function<void(double)>& whole, double from, double to) {
  if (!whole) return {};
  return [=](double part) { whole(std::lerp(from, to, part)); };
}

schema::Error no_ticks_in(const std::string& path, const std::optional<std::uint64_t>& damaged_at) {
  if (!damaged_at) return {ErrorKind::unsuitable, "has no ticks", path, ""};
  return {ErrorKind::malformed, fmt::format("is damaged from byte {} on, before its first tick", *damaged_at),
          path, "restore the original file"};
}

Result<SessionOverview> session_overview(const std::string& name,
                                         const std::function<void(double)>& progress) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  if (reader->header().forces)
    return fail(ErrorKind::unsuitable, "is a session of forces: it has no drive and no strokes",
                reader->path(), "`tactograph session` exports it, `tactograph replay` computes it again");
  SessionOverview overview;
  Surveyor surveyor(reader->header(), overview);
  while (const auto block = reader->next()) {
    std::visit(surveyor, *block);
    if (progress) progress(part_read(*reader));
  }
  surveyor.finish();
  overview.path = reader->path();
  if (reader->ending() == schema::SessionEnding::damaged) overview.damaged_at = reader->sound_bytes();
  if (overview.ticks == 0) return tl::unexpected(no_ticks_in(overview.path, overview.damaged_at));
  overview.closed = reader->ending() == schema::SessionEnding::closed;
  return overview;
}

RowMaker::RowMaker(const SessionOverview& overview, std::uint64_t most_filled)
    : overview_(overview), most_put_in_(most_filled), gain_(overview.header.initial_gain) {}

void RowMaker::begin_at(const SessionTick& tick) {
  first_ns_ = tick.time_ns;
  count_ = last_.encoder = tick.encoder;
}

void RowMaker::count_to(std::int32_t encoder) {
  count_ += core::counts_between(last_.encoder, encoder);
}

SessionRow RowMaker::row_of(const SessionTick& tick) const {
  SessionRow row;
  row.tick = tick.tick;
  row.time_s = seconds_since(first_ns_, tick.time_ns);
  row.device_time_s = seconds_since(0, tick.time_ns);
  row.position_m = overview_.header.metres_per_count * (static_cast<double>(count_) + 0.5);
  row.drive_v = tick.drive_v;
  row.flags = tick.flags;
  row.encoder = tick.encoder;
  return row;
}

// If a stop is not filled completely, the rows next to it keep their times.
double RowMaker::time_between(double to_s, std::uint64_t i, std::uint64_t periods,
                              std::uint64_t missing) const {
  const double from_s = last_.time_s, rate_hz = overview_.header.rate_hz;
  const auto after = static_cast<double>(i), before = static_cast<double>(periods + 1 - i);
  if (periods == missing) return std::lerp(from_s, to_s, after / static_cast<double>(periods + 1));
  return after < before ? from_s + after / rate_hz : to_s - before / rate_hz;
}

void RowMaker::put_in_before(const SessionRow& row, const Sink& sink) {
  const double rate_hz = overview_.header.rate_hz;
  const std::uint64_t missing = periods_between(last_.time_s, row.time_s, rate_hz);
  const std::uint64_t periods = std::min(missing, most_put_in_);
  SessionRow between = last_;
  between.put_in = true;
  if (missing > longest_gap(rate_hz)) between.flags &= ~std::uint32_t{wire::kTickPlaying};
  for (std::uint64_t i = 1; i <= periods; ++i, ++rows_) {
    const double u = static_cast<double>(i) / static_cast<double>(periods + 1);
    between.time_s = time_between(row.time_s, i, periods, missing);
    between.device_time_s = row.device_time_s - (row.time_s - between.time_s);
    between.position_m = std::lerp(last_.position_m, row.position_m, u);
    between.drive_v = std::lerp(last_.drive_v, row.drive_v, u);
    sink(between);
  }
}

void RowMaker::steer(SessionRow& row) {
  const auto steered = static_cast<std::uint8_t>(row.flags >> wire::kTickSteeredShift);
  for (; taken_ != steered && next_step_ < overview_.steps.size(); ++taken_, ++next_step_) {
    const SteeringStep& step = overview_.steps[next_step_];
    gain_ = step.gain.value_or(gain_);
    if (!step.turn) continue;
    turns_.push_back(*step.turn);
    turns_.back().row = rows_;
    turns_.back().time_s = row.time_s;
  }
  row.gain = gain_;
  row.turns = static_cast<std::uint32_t>(turns_.size());
}

void RowMaker::take(const SessionTick& tick, const Sink& sink) {
  if (rows_ == 0) begin_at(tick);
  count_to(tick.encoder);
  SessionRow row = row_of(tick);
  if (rows_ > 0 && most_put_in_ > 0) put_in_before(row, sink);
  steer(row);
  sink(row);
  last_ = row;
  ++rows_;
}

Result<void> read_rows(RowMaker& maker, const std::string& name, const RowMaker::Sink& sink,
                       const std::function<void(double)>& progress) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block))
      for (const SessionTick& tick : *ticks) maker.take(tick, sink);
    if (progress) progress(part_read(*reader));
  }
  return {};
}

}  // namespace tacto::playback
