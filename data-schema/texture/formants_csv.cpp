// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/base/table_text.hpp"
#include "data-schema/texture/formants.hpp"

namespace tacto::schema {

std::string formants_csv(const FormantFile& file) {
  const std::string reference = file.tables.empty() ? "" : file.tables.front().level_reference;
  std::string text = fmt::format(
      "texture,from_mm,to_mm,open_from,open_to,frequency_per_mm,lowest_per_mm,highest_per_mm,width_per_mm,"
      "\"level (dB re {})\",\"peak level (dB re {})\",peak_position_mm,prominence_db\n",
      reference, reference);
  for (const FormantTable& table : file.tables)
    for (const Formant& f : table.formants)
      text += fmt::format("{},{},{},{:d},{:d},{},{},{},{},{},{},{},{}\n", csv_cell(table.texture),
                          csv_number(1e3 * f.from_m), csv_number(1e3 * f.to_m), f.open_from, f.open_to,
                          csv_number(1e-3 * f.frequency_per_m), csv_number(1e-3 * f.lowest_per_m),
                          csv_number(1e-3 * f.highest_per_m), csv_number(1e-3 * f.width_per_m),
                          csv_number(f.level_db, 6), csv_number(f.peak_level_db, 6),
                          csv_number(1e3 * f.peak_position_m), csv_number(f.prominence_db, 6));
  return text;
}

}  // namespace tacto::schema
