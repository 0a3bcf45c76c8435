// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_query.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tacto::analysis {

using schema::ErrorKind;

schema::Result<void> read_query(const std::string& query, const std::string& names,
                                const std::function<bool(std::string_view name, double value)>& take) {
  for (std::size_t at = 0; at < query.size();) {
    const std::size_t end = std::min(query.find('&', at), query.size());
    const std::string one = query.substr(at, end - at);
    at = end + 1;
    const std::size_t equals = std::min(one.find('='), one.size());
    const std::string name = one.substr(0, equals);
    double value = NAN;
    const char* const last = one.data() + one.size();
    const auto read = std::from_chars(one.data() + std::min(equals + 1, one.size()), last, value);
    if (read.ec != std::errc() || read.ptr != last || !std::isfinite(value))
      return schema::fail(ErrorKind::usage, "is not NAME=NUMBER", one);
    if (!take(name, value)) return schema::fail(ErrorKind::usage, "is not known", name, "use " + names);
  }
  return {};
}

}  // namespace tacto::analysis
