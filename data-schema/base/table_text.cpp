// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/table_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tacto::schema {

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "";
}

}  // namespace tacto::schema
