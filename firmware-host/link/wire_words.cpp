// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/link/wire_words.hpp"

#include <fmt/format.h>

#include <utility>

namespace tacto::firmware_host {

using wire::AnswerCode;
using wire::DriveState;
using wire::FaultCode;
using wire::MessageType;

FaultWords words_of(FaultCode code, std::uint32_t detail) {
  switch (code) {
    case FaultCode::none:
      return {"no fault", ""};
    case FaultCode::host_silent:
      return {fmt::format("the device received nothing from this computer for {} ticks", detail),
              "check whether the computer stalls, or use a longer watchdog time"};
    case FaultCode::enable_open:
      return {"the hardware enable input is open", "close it, disarm and arm again"};
    case FaultCode::encoder_jump:
      return {fmt::format("the encoder jumped by {} counts in one tick", detail),
              "check the encoder's cable and mount, and whether the finger can exceed the speed limit "
              "(daemon: most_speed_mps); then disarm and arm again"};
    case FaultCode::drive_underrun:
      return {fmt::format("no drive from this computer arrived for {} ticks", detail),
              "send the drive earlier, or let the device close the loop"};
    case FaultCode::not_a_number:
      return {"the drive was not a finite number", "check texture, gain and filters"};
    case FaultCode::converter:
      return {"a converter of the device failed", "check its supply and its cables"};
    case FaultCode::ring_full:
      return {fmt::format("the device could not send fast enough; {} records are lost", detail),
              "use a lower rate or fewer channels"};
  }
  return {fmt::format("the device reports fault {} of a newer version", static_cast<int>(code)),
          "update tactograph"};
}

FaultWords words_of(AnswerCode code, std::uint32_t detail) {
  switch (code) {
    case AnswerCode::ok:
      return {"done", ""};
    case AnswerCode::unknown_type:
      return {"this command is unknown to the device", "update its firmware"};
    case AnswerCode::bad_payload:
      return {fmt::format("the device cannot read a payload of {} bytes", detail), ""};
    case AnswerCode::bad_value:
      return {fmt::format("value {} is out of the device's range", detail + 1),
              "the limits are in its description"};
    case AnswerCode::wrong_state:
      return {fmt::format("the device is {}", to_string(static_cast<DriveState>(detail))), "disarm first"};
    case AnswerCode::too_large:
      return {fmt::format("the limit of the device is {}", detail), ""};
    case AnswerCode::check_failed:
      return {"the received data differ from the sent data", "send it again"};
    case AnswerCode::incomplete:
      return {fmt::format("the device received only {} samples", detail), "send the remaining samples"};
    case AnswerCode::no_limits:
      return {"the device has no limits yet", "set them before arming"};
    case AnswerCode::enable_open:
      return {"the hardware enable input is open", "close it"};
    case AnswerCode::wrong_version:
      return {fmt::format("the device uses version {} of the protocol", detail), "update the older side"};
  }
  return {fmt::format("the device refused with the unknown reason {}", static_cast<int>(code)),
          "update tactograph"};
}

std::string_view to_string(DriveState state) {
  constexpr std::string_view kWords[] = {"idle", "armed", "playing", "in fault"};
  const auto index = static_cast<std::size_t>(state);
  return index < std::size(kWords) ? kWords[index] : "not connected yet";
}

std::string_view to_string(MessageType type) {
  constexpr std::pair<MessageType, std::string_view> kWords[] = {
      {MessageType::hello, "hello"},
      {MessageType::stream_start, "stream_start"},
      {MessageType::stream_stop, "stream_stop"},
      {MessageType::limits, "limits"},
      {MessageType::profile_begin, "profile_begin"},
      {MessageType::profile_chunk, "profile_chunk"},
      {MessageType::profile_end, "profile_end"},
      {MessageType::filters, "filters"},
      {MessageType::gain, "gain"},
      {MessageType::sweep, "sweep"},
      {MessageType::arm, "arm"},
      {MessageType::play, "play"},
      {MessageType::stop, "stop"},
      {MessageType::disarm, "disarm"},
      {MessageType::drive, "drive"},
      {MessageType::heartbeat, "heartbeat"},
      {MessageType::reset, "reset"},
      {MessageType::profile_levels, "profile_levels"},
      {MessageType::taps, "taps"},
      {MessageType::tracking, "tracking"},
      {MessageType::energy, "energy"},
      {MessageType::contact, "contact"},
      {MessageType::hysteresis, "hysteresis"},
      {MessageType::force_limits, "force_limits"},
      {MessageType::scene_part, "scene_part"},
      {MessageType::set, "set"},
      {MessageType::move, "move"},
      {MessageType::raise, "raise"},
      {MessageType::change, "change"},
  };
  for (const auto& [key, word] : kWords)
    if (key == type) return word;
  return "message";
}

}  // namespace tacto::firmware_host
