// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/terminal.hpp"

#include <fmt/format.h>

#include <string_view>

namespace tacto::cli {
namespace {

std::string escaped(const std::string& text, std::string_view kept) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if ((byte < 0x20 && kept.find(text[i]) == std::string_view::npos) || byte == 0x7F)
      shown += fmt::format("\\x{:02x}", byte);
    else if (byte == 0xC2 && next >= 0x80 && next < 0xA0)
      shown += fmt::format("\\x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(text[++i])));
    else
      shown += text[i];
  }
  return shown;
}

}  // namespace

std::string without_controls(const std::string& text) {
  return escaped(text, "\n\t");
}

std::string shell_word(const std::string& text) {
  if (!text.empty() && text.find_first_of(" '\"$&;()<>|*?`\\#~!") == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string on_one_line(const std::string& text) {
  return escaped(text, "");
}

}  // namespace tacto::cli
