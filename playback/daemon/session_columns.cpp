// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/session_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "firmware-host/core/encoder_watch.hpp"
#include "firmware-host/core/wire/host_messages.hpp"
#include "playback/daemon/session_board.hpp"

namespace tacto::playback {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;
using schema::SessionTick;

constexpr std::size_t kMostColumnTicks = std::size_t{1} << 24;

constexpr std::size_t kMostTexturesKept = 65536;  // of all changes: a file may hold any number

struct SteeringStep {
  std::optional<double> gain;       // the factor, where it is a gain
  std::optional<TextureTurn> turn;  // where it is a change, its row yet to be found
};

// Each command that steers, in their order.
class SteeringSteps {
 public:
  SteeringSteps(double textures_gain, double rate_hz) : textures_gain_(textures_gain), rate_hz_(rate_hz) {}

  void see(const schema::SessionCommand& command) {
    if (!is_frame(command.frame)) return;
    const auto type = static_cast<wire::MessageType>(command.frame[3]);
    if (armed_ && wire::steers(type)) steps_.push_back({factor_of(command), turn_of(command)});
    if (const auto tracking = message_in_frame<wire::Tracking>(command.frame); tracking && !armed_)
      look_ahead_ticks_ = tracking->look_ahead_ticks;
    armed_ = armed_ || type == wire::MessageType::arm;
  }
  void see(const schema::SessionChange& change) { next_ = change.program; }
  const std::vector<SteeringStep>& steps() const { return steps_; }
  double look_ahead_ticks() const { return look_ahead_ticks_; }

 private:
  std::optional<double> factor_of(const schema::SessionCommand& command) const {
    const auto gain = message_in_frame<wire::Gain>(command.frame);
    return gain ? std::optional(gain->gain / textures_gain_) : std::nullopt;
  }
  std::optional<TextureTurn> turn_of(const schema::SessionCommand& command) {
    const auto change = message_in_frame<wire::Change>(command.frame);
    if (!change) return std::nullopt;
    TextureTurn turn{0, change->fade_s * rate_hz_, std::exchange(next_, std::nullopt)};
    textures_ += turn.brings ? turn.brings->textures.size() : 0;
    if (textures_ > kMostTexturesKept) turn.brings.reset();
    return turn;
  }

  double textures_gain_, rate_hz_, look_ahead_ticks_ = 0;
  bool armed_ = false;
  std::vector<SteeringStep> steps_;
  std::optional<schema::SessionProgram> next_;  // what the next change brings
  std::size_t textures_ = 0;
};

// The greatest of the textures' gains is the one that the device knows; the others are parts of it.
double shared_gain(const schema::SessionHeader& header) {
  double most = 0;
  for (const schema::SessionTexture& texture : header.textures)
    most = std::max(most, std::abs(texture.gain_m_per_n));
  return most == 0 ? 1 : most;
}

void add_row(SessionColumns& columns, const SessionTick& tick, std::int64_t first_ns) {
  columns.tick.push_back(tick.tick);
  columns.time_s.push_back(1e-9 * static_cast<double>(tick.time_ns - first_ns));
  columns.position_m.push_back(columns.header.metres_per_count * (tick.encoder + 0.5));
  columns.drive_v.push_back(tick.drive_v);
  columns.flags.push_back(tick.flags);
  columns.encoder.push_back(tick.encoder);
}

void follow_steps(SessionColumns& columns, const std::vector<SteeringStep>& steps) {
  double gain = columns.header.initial_gain;
  std::uint8_t taken = 0;
  std::size_t next = 0;
  columns.gain.reserve(columns.tick.size());
  for (const std::uint32_t flags : columns.flags) {
    const auto steered = static_cast<std::uint8_t>(flags >> wire::kTickSteeredShift);
    for (; taken != steered && next < steps.size(); ++taken, ++next) {
      gain = steps[next].gain.value_or(gain);
      if (!steps[next].turn) continue;
      columns.turns.push_back(*steps[next].turn);
      columns.turns.back().row = columns.gain.size();
    }
    columns.gain.push_back(gain);
  }
}

// Takes blocks in, one overload a kind.
class ColumnCollector {
 public:
  explicit ColumnCollector(const schema::SessionHeader& header)
      : steps_(shared_gain(header), header.rate_hz) {
    columns_.header = header;
  }
  void operator()(const schema::SessionLoss& loss) { told_lost_ += loss.count; }
  void operator()(const schema::SessionEnd& end) { told_lost_ = end.lost_ticks; }
  void operator()(const schema::SessionCommand& command) { steps_.see(command); }
  void operator()(const schema::SessionChange& change) { steps_.see(change); }
  void operator()(const schema::SessionEvent&) {}
  void operator()(const std::vector<SessionTick>& ticks) {
    full_ = columns_.tick.size() + ticks.size() > kMostColumnTicks;
    if (full_) return;
    if (columns_.tick.empty()) first_ns_ = ticks.front().time_ns;
    count_lost_before(ticks.front().tick);
    for (const SessionTick& tick : ticks) add_row(columns_, tick, first_ns_);
  }
  bool is_full() const { return full_; }

  SessionColumns take() {
    if (told_lost_ > columns_.lost && !columns_.lost_at) columns_.lost_at = next_tick();
    columns_.lost = std::max(columns_.lost, told_lost_);
    columns_.look_ahead_ticks = steps_.look_ahead_ticks();
    follow_steps(columns_, steps_.steps());
    return std::move(columns_);
  }

 private:
  std::uint64_t next_tick() const { return columns_.tick.empty() ? 0 : columns_.tick.back() + 1; }
  void count_lost_before(std::uint64_t tick) {
    if (tick <= next_tick()) return;
    if (!columns_.lost_at) columns_.lost_at = next_tick();
    columns_.lost += tick - next_tick();
  }

  SessionColumns columns_;
  SteeringSteps steps_;
  std::int64_t first_ns_ = 0;
  std::uint64_t told_lost_ = 0;
  bool full_ = false;
};

// How many periods passed without a tick before this row. Times in a message are counted on by the rate: half
// a period is no gap.
std::uint64_t periods_before(const SessionColumns& columns, std::size_t row) {
  if (row == 0) return 0;
  const double periods = (columns.time_s[row] - columns.time_s[row - 1]) * columns.header.rate_hz;
  return periods > 1.5 ? static_cast<std::uint64_t>(std::min(std::round(periods) - 1, 1e15)) : 0;
}

void copy_row(const SessionColumns& from, std::size_t row, SessionColumns& to) {
  to.tick.push_back(from.tick[row]);
  to.time_s.push_back(from.time_s[row]);
  to.position_m.push_back(from.position_m[row]);
  to.drive_v.push_back(from.drive_v[row]);
  to.gain.push_back(from.gain[row]);
  to.flags.push_back(from.flags[row]);
  to.encoder.push_back(from.encoder[row]);
}

// `periods` rows on the way to `row`.
void fill_before(const SessionColumns& from, std::size_t row, std::uint64_t periods, bool stop,
                 SessionColumns& to) {
  for (std::uint64_t i = 1; i <= periods; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(periods + 1);
    copy_row(from, row - 1, to);
    to.time_s.back() = std::lerp(from.time_s[row - 1], from.time_s[row], u);
    to.position_m.back() = std::lerp(from.position_m[row - 1], from.position_m[row], u);
    to.drive_v.back() = std::lerp(from.drive_v[row - 1], from.drive_v[row], u);
    if (stop) to.flags.back() &= ~std::uint32_t{wire::kTickPlaying};
  }
}

}  // namespace

schema::Error no_ticks_in(const std::string& path, const std::optional<std::uint64_t>& damaged_at) {
  if (!damaged_at) return {Fault::unsuitable, "holds no ticks", path, ""};
  return {Fault::malformed, fmt::format("is damaged from byte {} on, before its first tick", *damaged_at),
          path, "bring the right file back"};
}

Result<EvenColumns> evened(const SessionColumns& columns) {
  EvenColumns even;
  even.columns.header = columns.header;
  even.columns.lost_at = columns.lost_at;
  even.columns.lost = columns.lost;
  even.columns.damaged_at = columns.damaged_at;
  even.columns.turns = columns.turns;
  even.columns.look_ahead_ticks = columns.look_ahead_ticks;
  auto turn = even.columns.turns.begin();
  const auto longest = static_cast<std::uint64_t>(core::kBlindS * columns.header.rate_hz);
  for (std::size_t row = 0; row < columns.tick.size(); ++row) {
    const std::uint64_t missing = periods_before(columns, row);
    if (missing + columns.tick.size() + even.added > kMostColumnTicks)
      return fail(Fault::unsuitable, fmt::format("has over {} periods", kMostColumnTicks), "session",
                  "export it as CSV, which takes no memory");
    fill_before(columns, row, missing, missing > longest, even.columns);
    even.added += missing;
    even.stops += missing > longest;
    for (; turn != even.columns.turns.end() && turn->row == row; ++turn) turn->row = even.columns.tick.size();
    copy_row(columns, row, even.columns);
  }
  return even;
}

Result<SessionColumns> read_session_columns(const std::string& name) {
  auto reader = schema::SessionReader::open(name);
  if (!reader) return schema::forward_error(reader);
  ColumnCollector collector(reader->header());
  while (const auto block = reader->next()) {
    std::visit(collector, *block);
    if (collector.is_full())
      return fail(Fault::unsuitable, fmt::format("has over {} ticks", kMostColumnTicks), reader->path(),
                  "export it as CSV, which takes no memory");
  }
  SessionColumns columns = collector.take();
  if (reader->ending() == schema::SessionEnding::damaged) columns.damaged_at = reader->sound_bytes();
  if (columns.tick.empty()) return tl::unexpected(no_ticks_in(reader->path(), columns.damaged_at));
  columns.closed = reader->ending() == schema::SessionEnding::closed;
  return columns;
}

}  // namespace tacto::playback
