// SPDX-License-Identifier: GPL-3.0-or-later
// A formant as a row of a report.
#pragma once

#include <string>

#include "data-schema/report/report.hpp"
#include "data-schema/texture/formants.hpp"

namespace tacto::spatial {

inline cli::Report formant_row(const std::string& texture, const schema::Formant& formant) {
  cli::Report row;
  row.add("texture", texture).add("from_m", formant.from_m).add("to_m", formant.to_m);
  row.add("frequency_per_m", formant.frequency_per_m).add("width_per_m", formant.width_per_m);
  row.add("lowest_per_m", formant.lowest_per_m).add("highest_per_m", formant.highest_per_m);
  row.add("level_db", formant.level_db).add("prominence_db", formant.prominence_db);
  row.add("goes_on",
          formant.open_from ? (formant.open_to ? "both ends" : "before") : (formant.open_to ? "after" : ""));
  return row;
}

}  // namespace tacto::spatial
