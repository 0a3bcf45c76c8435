// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a session's blocks (SESSION.md). Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "data-schema/session/session.hpp"

namespace tacto::schema {

enum class BlockType : std::uint8_t {
  header = 0,
  ticks = 1,
  command = 2,
  loss = 3,
  event = 4,
  end = 5,
  change = 6,
  samples = 7,
  axis_ticks = 8
};

inline constexpr std::uint32_t kBlockMagic = 0x31534354;
inline constexpr std::size_t kBlockHead = 20;
inline constexpr std::size_t kMostPayload = std::size_t{1} << 20;
inline constexpr std::size_t kMostBlockTicks = 4096;

/// A whole block. Precondition: at most kMostPayload bytes.
std::string sealed_block(BlockType type, std::string_view payload);

/// The head of a block; none if the bytes are not a block's.
struct BlockHead {
  BlockType type = BlockType::header;
  std::size_t size = 0;
  std::string check;
};
std::optional<BlockHead> block_head(std::string_view bytes);
bool check_is_right(const BlockHead& head, std::string_view payload);

/// Payloads. Of ticks: at most kMostBlockTicks, without gaps, within 4 s.
std::string ticks_payload(std::span<const SessionTick> ticks);
/// The same for ticks of a force device.
std::string axis_ticks_payload(std::span<const SessionTick> ticks);
std::string command_payload(const SessionCommand& command);
std::string loss_payload(const SessionLoss& loss);
std::string event_payload(const SessionEvent& event);
/// At most kMostBlockTicks codes, at least one.
std::string samples_payload(std::uint64_t first_frame, std::int64_t time_ns,
                            std::span<const std::int32_t> codes);
std::string end_payload(const SessionEnd& end);
/// Errors: as session_program_text.
Result<std::string> change_payload(const SessionChange& change);

/// The reverse; none if the size does not fit.
std::optional<std::vector<SessionTick>> ticks_from(std::string_view payload);
std::optional<std::vector<SessionTick>> axis_ticks_from(std::string_view payload);
std::optional<SessionCommand> command_from(std::string_view payload);
std::optional<SessionLoss> loss_from(std::string_view payload);
std::optional<SessionEvent> event_from(std::string_view payload);
std::optional<SessionEnd> end_from(std::string_view payload);
std::optional<SessionChange> change_from(std::string_view payload);
std::optional<SessionSamples> samples_from(std::string_view payload);

}  // namespace tacto::schema
