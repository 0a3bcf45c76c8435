// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/html.hpp"

#include <fmt/format.h>
#include <nettle/base64.h>

#include <algorithm>

namespace tacto::analysis {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light; }
body { font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; color: #1d2126; background: #fff; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { font-size: 1.25rem; margin-top: 2.6rem; border-top: 1px solid #d5d9de; padding-top: 1.2rem; }
.simulated { background: #fff3d6; border-left: .4rem solid #e0a100; padding: .6rem 1rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; display: block; overflow-x: auto; }
th, td { padding: .35rem .8rem; text-align: right; border-bottom: 1px solid #e3e6ea; white-space: nowrap; }
th { font-weight: 600; vertical-align: bottom; } td:first-child, th:first-child { text-align: left; }
img { width: 100%; height: auto; margin: .6rem 0; } p.note { color: #56606b; font-size: .9rem; }
)";

std::string base64(std::string_view bytes) {
  std::string text(BASE64_ENCODE_RAW_LENGTH(bytes.size()), '\0');
  base64_encode_raw(text.data(), bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  return text;
}

std::string table_row(const std::vector<std::string>& cells, std::string_view tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) row += fmt::format("<{0}>{1}</{0}>", tag, escaped(cell));
  return row + "</tr>\n";
}

std::string entity(char c) {
  if (c == '<') return "&lt;";
  if (c == '>') return "&gt;";
  if (c == '&') return "&amp;";
  return c == '"' ? "&quot;" : std::string(1, c);
}

// How long the first sign of UTF-8 is; 0 where it is none (names of files may be any bytes).
std::size_t sign_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t bytes = byte(0) >= 0xF0 && byte(0) < 0xF5   ? 4
                            : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                            : byte(0) >= 0xC2 && byte(0) < 0xE0 ? 2
                                                                : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  return bytes;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = sign_bytes(text.substr(i));
    safe += bytes == 0 ? "\uFFFD" : bytes == 1 ? entity(text[i]) : std::string(text.substr(i, bytes));
    i += std::max<std::size_t>(1, bytes);
  }
  return safe;
}

std::string inline_svg(std::string_view svg, std::string_view alternative) {
  return fmt::format("<img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">\n", escaped(alternative),
                     base64(svg));
}

std::string html_table(const std::vector<std::vector<std::string>>& rows) {
  std::string table = "<table>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) table += table_row(rows[i], i == 0 ? "th" : "td");
  return table + "</table>\n";
}

std::string html_document(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style></head>\n<body>\n{}</body></html>\n",
      escaped(title), kStyle, body);
}

}  // namespace tacto::analysis
