// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/session/ticks_base64.hpp"

#include <cstdint>
#include <string_view>

#include "data-schema/session/session_blocks.hpp"

namespace tacto::schema {
namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::string_view part = bytes.substr(at, 3);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i)
      bits = bits << 8U | (i < part.size() ? static_cast<unsigned char>(part[i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      text += i <= part.size() ? kDigits[bits >> (18U - 6U * i) & 63U] : '=';
  }
  return text;
}

}  // namespace

std::string ticks_base64(std::span<const SessionTick> ticks) {
  return base64(ticks.front().axes > 0 ? axis_ticks_payload(ticks) : ticks_payload(ticks));
}

}  // namespace tacto::schema
