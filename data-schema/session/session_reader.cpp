// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/session/session_reader.hpp"

#include <fstream>

#include "data-schema/files/files.hpp"
#include "data-schema/session/session_blocks.hpp"

namespace tacto::schema {
namespace {

constexpr std::uint32_t kLateFlag = 32;  // firmware-host/core/WIRE.md
constexpr std::uint8_t kChangeMessage = 0x17;
constexpr std::size_t kTypeInFrame = 3;
constexpr std::size_t kMostEventsKept = 1000;  // of the totals: a file may hold any number

template <class Part>
std::optional<SessionBlock> block_of(std::optional<Part> part) {
  if (!part) return std::nullopt;
  return SessionBlock(std::move(*part));
}

std::optional<SessionBlock> decoded(BlockType type, std::string_view payload) {
  switch (type) {
    case BlockType::ticks:
      return block_of(ticks_from(payload));
    case BlockType::command:
      return block_of(command_from(payload));
    case BlockType::loss:
      return block_of(loss_from(payload));
    case BlockType::event:
      return block_of(event_from(payload));
    case BlockType::end:
      return block_of(end_from(payload));
    case BlockType::change:
      return block_of(change_from(payload));
    case BlockType::samples:
      return block_of(samples_from(payload));
    case BlockType::axis_ticks:
      return block_of(axis_ticks_from(payload));
    case BlockType::header:
      break;
  }
  return std::nullopt;
}

bool is_known(BlockType type) {
  return type >= BlockType::ticks && type <= BlockType::axis_ticks;
}

}  // namespace

struct SessionReader::State {
  std::string path;
  std::ifstream file;
  SessionHeader header;
  std::string payload;
  std::uint64_t sound_bytes = 0;
  SessionEnding ending = SessionEnding::unread;

  // A whole block with a right check; none at the end, with `ending` set.
  std::optional<BlockType> take() {
    std::string bytes(kBlockHead, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (file.gcount() == 0) return ended(SessionEnding::unclosed);
    const auto head = block_head(std::string_view(bytes).substr(0, static_cast<std::size_t>(file.gcount())));
    if (!head) return ended(SessionEnding::damaged);
    payload.resize(head->size);
    file.read(payload.data(), static_cast<std::streamsize>(payload.size()));
    const bool whole = static_cast<std::size_t>(file.gcount()) == head->size;
    if (!whole || !check_is_right(*head, payload)) return ended(SessionEnding::damaged);
    sound_bytes += kBlockHead + head->size;
    return head->type;
  }
  std::optional<BlockType> ended(SessionEnding how) {
    ending = how;
    return std::nullopt;
  }
};

SessionReader::SessionReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
SessionReader::SessionReader(SessionReader&&) noexcept = default;
SessionReader& SessionReader::operator=(SessionReader&&) noexcept = default;
SessionReader::~SessionReader() = default;

Result<SessionReader> SessionReader::open(const std::string& name) {
  auto state = std::make_unique<State>();
  state->path = session_path(name);
  TACTO_TRY(check_readable(state->path));
  state->file.open(state->path, std::ios::binary);
  const auto first = state->take();
  if (!first || *first != BlockType::header)
    return fail(ErrorKind::malformed, "does not begin with a session's header", state->path);
  auto header = parse_session_header(state->payload, state->path);
  TACTO_TRY(header);
  state->header = std::move(*header);
  return SessionReader(std::move(state));
}

const SessionHeader& SessionReader::header() const {
  return state_->header;
}
const std::string& SessionReader::path() const {
  return state_->path;
}
SessionEnding SessionReader::ending() const {
  return state_->ending;
}
std::uint64_t SessionReader::sound_bytes() const {
  return state_->sound_bytes;
}

std::optional<SessionBlock> SessionReader::next() {
  while (state_->ending == SessionEnding::unread) {
    const auto type = state_->take();
    if (!type) return std::nullopt;
    auto block = decoded(*type, state_->payload);
    if (!block && is_known(*type)) state_->ended(SessionEnding::damaged);
    if (*type == BlockType::end && block) state_->ended(SessionEnding::closed);
    if (block) return block;
  }
  return std::nullopt;
}

namespace {

// One overload for each kind of block.
struct Count {
  SessionTotals& totals;
  std::optional<SessionChange> next = {};

  void operator()(const std::vector<SessionTick>& ticks) {
    if (totals.ticks == 0) totals.first_ns = ticks.front().time_ns;
    totals.ticks += ticks.size();
    totals.last_ns = ticks.back().time_ns;
    for (const SessionTick& tick : ticks) totals.late_ticks += (tick.flags & kLateFlag) != 0;
  }
  void operator()(const SessionCommand& command) {
    ++totals.commands;
    if (command.frame.size() <= kTypeInFrame || command.frame[kTypeInFrame] != kChangeMessage) return;
    if (next && totals.changes.size() < kMostEventsKept) totals.changes.push_back(std::move(*next));
    next.reset();
  }
  void operator()(SessionChange& change) { next = std::move(change); }
  void operator()(const SessionLoss& loss) { totals.lost_ticks += loss.count; }
  // Of many events, keeps the first and the last.
  void operator()(const SessionEvent& event) {
    if (event.text.starts_with(kMarkEvent)) {
      if (totals.marks.size() < kMostMarks)
        totals.marks.push_back({event.tick, event.time_ns, event.text.substr(kMarkEvent.size())});
      return;
    }
    ++totals.event_count;
    if (totals.events.size() == kMostEventsKept)
      totals.events.erase(totals.events.begin() + kMostEventsKept / 2);
    totals.events.push_back(event);
  }
  void operator()(const SessionEnd& end) { totals.end = end; }
  void operator()(const SessionSamples& samples) {
    totals.samples_grow = totals.samples_grow && samples.first_frame >= next_frame;
    if (totals.samples > 0 && samples.first_frame > next_frame)
      totals.lost_samples += samples.first_frame - next_frame;
    totals.samples += samples.codes.size();
    next_frame = samples.first_frame + samples.codes.size();
  }
  std::uint64_t next_frame = 0;
};

}  // namespace

SessionTotals session_totals(SessionReader& reader) {
  SessionTotals totals;
  Count count{totals};
  while (auto block = reader.next()) std::visit(count, *block);
  totals.ending = reader.ending();
  return totals;
}

std::string session_path(const std::string& name) {
  return name.ends_with(".session") ? name : name + ".session";
}

}  // namespace tacto::schema
