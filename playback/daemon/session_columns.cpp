// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/session_columns.hpp"

#include <fmt/format.h>

#include <cmath>

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
    if (std::abs(texture.gain_m_per_n) > std::abs(most)) most = texture.gain_m_per_n;
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

}  // namespace

Result<SessionColumns> read_session_columns(const std::string& name) {
  auto reader = schema::SessionReader::open(name);
  if (!reader) return schema::forward_error(reader);
  SessionColumns columns;
  columns.header = reader->header();
  SteeringSteps steps;
  steps.textures_gain = shared_gain(columns.header);
  std::int64_t first_ns = 0;
  while (const auto block = reader->next()) {
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
  if (columns.tick.empty()) return fail(Fault::unsuitable, "holds no ticks", reader->path());
  follow_steps(columns, steps.steps);
  return columns;
}

}  // namespace tacto::playback
