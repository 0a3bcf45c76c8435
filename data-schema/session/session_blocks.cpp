// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/session/session_blocks.hpp"

#include <bit>
#include <cstring>
#include <type_traits>

#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied in the memory's byte order");

constexpr std::size_t kTickBytes = 20, kCheckBytes = 8, kTicksHead = 20, kMomentBytes = 16;

template <class Number>
void append_number(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof raw);
}

// Reads numbers from the front of a payload that is long enough.
class NumberReader {
 public:
  explicit NumberReader(std::string_view bytes) : bytes_(bytes) {}
  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  std::string_view rest() const { return bytes_; }

 private:
  std::string_view bytes_;
};

std::string hex_of_check(BlockType type, std::string_view payload) {
  std::string bytes;
  bytes.reserve(payload.size() + 5);
  append_number(bytes, type);
  append_number(bytes, static_cast<std::uint32_t>(payload.size()));
  bytes += payload;
  return sha256_of(bytes).substr(0, 2 * kCheckBytes);
}

std::uint64_t check_of(BlockType type, std::string_view payload) {
  return __builtin_bswap64(std::stoull(hex_of_check(type, payload), nullptr, 16));
}

}  // namespace

std::string sealed_block(BlockType type, std::string_view payload) {
  std::string block;
  block.reserve(kBlockHead + payload.size());
  append_number(block, kBlockMagic);
  append_number(block, type);
  block.append(3, '\0');
  append_number(block, static_cast<std::uint32_t>(payload.size()));
  append_number(block, check_of(type, payload));
  block += payload;
  return block;
}

std::optional<BlockHead> block_head(std::string_view bytes) {
  if (bytes.size() < kBlockHead) return std::nullopt;
  NumberReader take(bytes);
  if (take.number<std::uint32_t>() != kBlockMagic) return std::nullopt;
  BlockHead head;
  head.type = take.number<BlockType>();
  for (int i = 0; i < 3; ++i) take.number<char>();
  head.size = take.number<std::uint32_t>();
  head.check = std::string(take.rest().substr(0, kCheckBytes));
  if (head.size > kMostPayload) return std::nullopt;
  return head;
}

bool check_is_right(const BlockHead& head, std::string_view payload) {
  std::string check;
  append_number(check, check_of(head.type, payload));
  return check == head.check;
}

std::string ticks_payload(std::span<const SessionTick> ticks) {
  std::string bytes;
  bytes.reserve(kTicksHead + kTickBytes * ticks.size());
  append_number(bytes, ticks.front().tick);
  append_number(bytes, ticks.front().time_ns);
  append_number(bytes, static_cast<std::uint32_t>(ticks.size()));
  for (const SessionTick& tick : ticks) {
    append_number(bytes, static_cast<std::uint32_t>(tick.time_ns - ticks.front().time_ns));
    append_number(bytes, tick.encoder);
    append_number(bytes, tick.drive_v);
    append_number(bytes, tick.flags);
    append_number(bytes, tick.lateness_ns);
  }
  return bytes;
}

std::optional<std::vector<SessionTick>> ticks_from(std::string_view payload) {
  if (payload.size() < kTicksHead) return std::nullopt;
  NumberReader take(payload);
  const auto first = take.number<std::uint64_t>();
  const auto time_ns = take.number<std::int64_t>();
  const auto count = take.number<std::uint32_t>();
  if (count == 0 || take.rest().size() != count * kTickBytes) return std::nullopt;
  std::vector<SessionTick> ticks(count);
  for (SessionTick& tick : ticks) {
    tick.tick = first + static_cast<std::uint64_t>(&tick - ticks.data());
    // Unsigned: a damaged time may wrap, which is defined for unsigned numbers.
    tick.time_ns =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(time_ns) + take.number<std::uint32_t>());
    tick.encoder = take.number<std::int32_t>();
    tick.drive_v = take.number<float>();
    tick.flags = take.number<std::uint32_t>();
    tick.lateness_ns = take.number<std::int32_t>();
  }
  return ticks;
}

std::string axis_ticks_payload(std::span<const SessionTick> ticks) {
  std::string bytes;
  append_number(bytes, ticks.front().tick);
  append_number(bytes, ticks.front().time_ns);
  append_number(bytes, static_cast<std::uint32_t>(ticks.size()));
  append_number(bytes, std::uint32_t{ticks.front().axes});
  for (const SessionTick& tick : ticks) {
    append_number(bytes, static_cast<std::uint32_t>(tick.time_ns - ticks.front().time_ns));
    for (std::size_t i = 0; i < tick.axes; ++i) append_number(bytes, tick.counts[i]);
    for (std::size_t i = 0; i < tick.axes; ++i) append_number(bytes, tick.force_n[i]);
    append_number(bytes, tick.flags);
  }
  return bytes;
}

std::optional<std::vector<SessionTick>> axis_ticks_from(std::string_view payload) {
  if (payload.size() < kTicksHead + sizeof(std::uint32_t)) return std::nullopt;
  NumberReader take(payload);
  const auto first = take.number<std::uint64_t>();
  const auto time_ns = take.number<std::int64_t>();
  const auto count = take.number<std::uint32_t>();
  const auto axes = take.number<std::uint32_t>();
  if (count == 0 || axes == 0 || axes > SessionTick{}.counts.size() ||
      take.rest().size() != std::size_t{count} * (8 + 8 * axes))
    return std::nullopt;
  std::vector<SessionTick> ticks(count);
  for (SessionTick& tick : ticks) {
    tick.tick = first + static_cast<std::uint64_t>(&tick - ticks.data());
    tick.time_ns =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(time_ns) + take.number<std::uint32_t>());
    tick.axes = static_cast<std::uint8_t>(axes);
    for (std::size_t i = 0; i < axes; ++i) tick.counts[i] = take.number<std::int32_t>();
    for (std::size_t i = 0; i < axes; ++i) tick.force_n[i] = take.number<float>();
    tick.flags = take.number<std::uint32_t>();
    tick.encoder = tick.counts[0];
  }
  return ticks;
}

std::string command_payload(const SessionCommand& command) {
  std::string bytes;
  append_number(bytes, command.not_before);
  append_number(bytes, command.time_ns);
  bytes.append(reinterpret_cast<const char*>(command.frame.data()), command.frame.size());
  return bytes;
}

std::optional<SessionCommand> command_from(std::string_view payload) {
  if (payload.size() < kMomentBytes) return std::nullopt;
  NumberReader take(payload);
  SessionCommand command;
  command.not_before = take.number<std::uint64_t>();
  command.time_ns = take.number<std::int64_t>();
  command.frame.assign(take.rest().begin(), take.rest().end());
  return command;
}

std::string loss_payload(const SessionLoss& loss) {
  std::string bytes;
  append_number(bytes, loss.first_tick);
  append_number(bytes, loss.count);
  append_number(bytes, loss.why);
  return bytes;
}

std::optional<SessionLoss> loss_from(std::string_view payload) {
  if (payload.size() != 17) return std::nullopt;
  NumberReader take(payload);
  SessionLoss loss;
  loss.first_tick = take.number<std::uint64_t>();
  loss.count = take.number<std::uint64_t>();
  loss.why = take.number<SessionLoss::Why>();
  return loss;
}

std::string event_payload(const SessionEvent& event) {
  std::string bytes;
  append_number(bytes, event.tick);
  append_number(bytes, event.time_ns);
  return bytes + event.text;
}

std::optional<SessionEvent> event_from(std::string_view payload) {
  if (payload.size() < kMomentBytes) return std::nullopt;
  NumberReader take(payload);
  SessionEvent event;
  event.tick = take.number<std::uint64_t>();
  event.time_ns = take.number<std::int64_t>();
  event.text = std::string(take.rest());
  return event;
}

Result<std::string> change_payload(const SessionChange& change) {
  const auto text = session_program_text(change.program);
  TACTO_TRY(text);
  std::string bytes;
  append_number(bytes, change.not_before);
  append_number(bytes, change.time_ns);
  return bytes + *text;
}

std::optional<SessionChange> change_from(std::string_view payload) {
  if (payload.size() < kMomentBytes) return std::nullopt;
  NumberReader take(payload);
  SessionChange change;
  change.not_before = take.number<std::uint64_t>();
  change.time_ns = take.number<std::int64_t>();
  auto program = parse_session_program(take.rest(), "change");
  if (!program) return std::nullopt;
  change.program = std::move(*program);
  return change;
}

std::string samples_payload(std::uint64_t first_frame, std::int64_t time_ns,
                            std::span<const std::int32_t> codes) {
  std::string bytes;
  append_number(bytes, first_frame);
  append_number(bytes, time_ns);
  append_number(bytes, static_cast<std::uint32_t>(codes.size()));
  return bytes.append(reinterpret_cast<const char*>(codes.data()), codes.size_bytes());
}

std::optional<SessionSamples> samples_from(std::string_view payload) {
  if (payload.size() < kTicksHead) return std::nullopt;
  NumberReader take(payload);
  SessionSamples samples;
  samples.first_frame = take.number<std::uint64_t>();
  samples.time_ns = take.number<std::int64_t>();
  const auto count = take.number<std::uint32_t>();
  if (count == 0 || take.rest().size() != count * sizeof(std::int32_t)) return std::nullopt;
  samples.codes.resize(count);
  std::memcpy(samples.codes.data(), take.rest().data(), take.rest().size());
  return samples;
}

std::string end_payload(const SessionEnd& end) {
  std::string bytes;
  for (const std::uint64_t number : {end.ticks, end.lost_ticks, end.late_ticks}) append_number(bytes, number);
  return bytes;
}

std::optional<SessionEnd> end_from(std::string_view payload) {
  if (payload.size() != 3 * sizeof(std::uint64_t)) return std::nullopt;
  NumberReader take(payload);
  SessionEnd end;
  end.ticks = take.number<std::uint64_t>();
  end.lost_ticks = take.number<std::uint64_t>();
  end.late_ticks = take.number<std::uint64_t>();
  return end;
}

}  // namespace tacto::schema
