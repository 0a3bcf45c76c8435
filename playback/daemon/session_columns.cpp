// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/session_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

struct SteeringStep {
  std::optional<double> gain;  // the factor, where it is a gain
  bool changes_texture = false;
};

// Each command that steers, in their order.
struct SteeringSteps {
  std::vector<SteeringStep> steps;
  double textures_gain = 1;
  bool armed = false;

  void see(const schema::SessionCommand& command) {
    if (!is_frame(command.frame)) return;
    const auto type = static_cast<wire::MessageType>(command.frame[3]);
    if (armed && wire::steers(type))
      steps.push_back({factor_of(command, type), type == wire::MessageType::change});
    armed = armed || type == wire::MessageType::arm;
  }
  std::optional<double> factor_of(const schema::SessionCommand& command, wire::MessageType type) const {
    wire::Gain gain;
    const std::size_t payload = command.frame.size() - wire::kHeaderSize - wire::kCheckSize;
    const bool is_gain =
        type == wire::MessageType::gain &&
        wire::parse(command.frame.data() + wire::kHeaderSize, payload, gain) == wire::Parse::ok;
    return is_gain ? std::optional(gain.gain / textures_gain) : std::nullopt;
  }
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
      if (steps[next].changes_texture && !columns.changed_at) columns.changed_at = columns.gain.size();
    }
    columns.gain.push_back(gain);
  }
}

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
  const auto longest = static_cast<std::uint64_t>(core::kBlindS * columns.header.rate_hz);
  for (std::size_t row = 0; row < columns.tick.size(); ++row) {
    const std::uint64_t missing = periods_before(columns, row);
    if (missing + columns.tick.size() + even.added > kMostColumnTicks)
      return fail(Fault::unsuitable, fmt::format("has over {} periods", kMostColumnTicks), "session",
                  "export it as CSV, which takes no memory");
    fill_before(columns, row, missing, missing > longest, even.columns);
    even.added += missing;
    even.stops += missing > longest;
    if (columns.changed_at == row) even.columns.changed_at = even.columns.tick.size();
    copy_row(columns, row, even.columns);
  }
  return even;
}

Result<SessionColumns> read_session_columns(const std::string& name) {
  auto reader = schema::SessionReader::open(name);
  if (!reader) return schema::forward_error(reader);
  SessionColumns columns;
  columns.header = reader->header();
  SteeringSteps steps;
  steps.textures_gain = shared_gain(columns.header);
  std::int64_t first_ns = 0;
  std::uint64_t told_lost = 0;
  while (const auto block = reader->next()) {
    if (const auto* loss = std::get_if<schema::SessionLoss>(&*block)) told_lost += loss->count;
    if (const auto* end = std::get_if<schema::SessionEnd>(&*block)) told_lost = end->lost_ticks;
    if (const auto* command = std::get_if<schema::SessionCommand>(&*block)) steps.see(*command);
    const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block);
    if (ticks == nullptr) continue;
    if (columns.tick.empty()) first_ns = ticks->front().time_ns;
    const std::uint64_t expected = columns.tick.empty() ? 0 : columns.tick.back() + 1;
    if (ticks->front().tick > expected) {
      if (!columns.lost_at) columns.lost_at = expected;
      columns.lost += ticks->front().tick - expected;
    }
    if (columns.tick.size() + ticks->size() > kMostColumnTicks)
      return fail(Fault::unsuitable, fmt::format("has over {} ticks", kMostColumnTicks), reader->path(),
                  "export it as CSV, which takes no memory");
    for (const SessionTick& tick : *ticks) add_row(columns, tick, first_ns);
  }
  if (reader->ending() == schema::SessionEnding::damaged) columns.damaged_at = reader->sound_bytes();
  if (columns.tick.empty()) return tl::unexpected(no_ticks_in(reader->path(), columns.damaged_at));
  if (told_lost > columns.lost && !columns.lost_at) columns.lost_at = columns.tick.back() + 1;
  columns.lost = std::max(columns.lost, told_lost);
  columns.closed = reader->ending() == schema::SessionEnding::closed;
  follow_steps(columns, steps.steps);
  return columns;
}

}  // namespace tacto::playback
