// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "analysis/identify/measure/number_table.hpp"
#include "analysis/identify/measure/taps.hpp"

namespace tacto::analysis {

schema::Result<Taps> read_taps(const std::string& path, double rate_hz) {
  const auto table = read_numbers(path);
  TACTO_TRY(table);
  if (table->names.size() < 2)
    return schema::fail(schema::ErrorKind::malformed,
                        "it has one column: taps need a column of tap numbers and one of values", path);
  Taps taps{rate_hz, {}};
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const std::string name = fmt::format("{:g}", table->at(row, 0));
    if (taps.taps.empty() || taps.taps.back().name != name) taps.taps.push_back({name, {}});
    taps.taps.back().value.push_back(table->at(row, table->names.size() - 1));
  }
  return taps;
}

}  // namespace tacto::analysis
