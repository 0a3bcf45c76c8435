// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/formants.hpp"
#include "data-schema/table_text.hpp"

namespace tacto::schema {

std::string formants_csv(const FormantFile& file) {
  const std::string reference = file.tables.empty() ? "" : file.tables.front().level_reference;
  std::string text = fmt::format(
      "texture,from_mm,to_mm,open_from,open_to,frequency_per_mm,lowest_per_mm,highest_per_mm,width_per_mm,"
      "\"level (dB re {})\",\"peak level (dB re {})\",peak_position_mm,prominence_db\n",
      reference, reference);
  for (const FormantTable& table : file.tables)
    for (const Formant& f : table.formants)
      text += fmt::format(
          "{},{:.9g},{:.9g},{:d},{:d},{:.9g},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.9g},{:.6g}\n",
          csv_cell(table.texture), 1e3 * f.from_m, 1e3 * f.to_m, f.open_from, f.open_to,
          1e-3 * f.frequency_per_m, 1e-3 * f.lowest_per_m, 1e-3 * f.highest_per_m, 1e-3 * f.width_per_m,
          f.level_db, f.peak_level_db, 1e3 * f.peak_position_m, f.prominence_db);
  return text;
}

}  // namespace tacto::schema
