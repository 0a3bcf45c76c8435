// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/svg_numbers.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>

namespace tacto::spatial {
namespace {

constexpr std::string_view kPath = " d=\"";

void append_rounded(double value, std::string& out) {
  const double rounded = std::round(value * 100) / 100;
  fmt::format_to(std::back_inserter(out), "{}", rounded == 0 ? 0.0 : rounded);  // avoids "-0"
}

// Appends the path data up to the closing quote: commands are unchanged, numbers are rounded.
void append_path(std::string_view data, std::string& out) {
  while (!data.empty()) {
    double value = 0;
    const auto [end, error] = std::from_chars(data.data(), data.data() + data.size(), value);
    if (error != std::errc()) {
      out += data.front();
      data.remove_prefix(1);
      continue;
    }
    append_rounded(value, out);
    data.remove_prefix(static_cast<std::size_t>(end - data.data()));
  }
}

}  // namespace

std::string with_rounded_paths(std::string_view svg) {
  std::string out;
  out.reserve(svg.size());
  for (std::size_t at = 0; at < svg.size();) {
    const std::size_t path = svg.find(kPath, at);
    const std::size_t data = path == svg.npos ? svg.npos : path + kPath.size();
    const std::size_t end = data == svg.npos ? svg.npos : svg.find('"', data);
    if (end == svg.npos) return out.append(svg.substr(at));
    out.append(svg.substr(at, data - at));
    append_path(svg.substr(data, end - data), out);
    at = end;
  }
  return out;
}

}  // namespace tacto::spatial
