// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "data-schema/calibration/calibration.hpp"
#include "data-schema/cli/describe.hpp"

namespace tacto::schema {
namespace {

// For a zero, which is a stored number, also its value in the channel's unit: by the entry's own scale, or
// the device's if it has none.
void add_zero(cli::Report& row, const CalibrationEntry& entry) {
  if (!entry.zero) return;
  const double scale = entry.scale.value_or(entry.nominal_scale);
  row.add("zero_as_stored", *entry.zero).add(key_in("zero", entry.unit), *entry.zero * scale);
  if (entry.zero_uncertainty)
    row.add(key_in("zero_uncertainty", entry.unit), std::abs(*entry.zero_uncertainty * scale));
}

cli::Report row_of(const CalibrationEntry& entry) {
  cli::Report row;
  row.add("channel", entry.channel).add("method", entry.method).add("date", entry.date);
  if (entry.scale) row.add("scale", *entry.scale).add("of_nominal", *entry.scale / entry.nominal_scale);
  if (entry.scale && entry.scale_uncertainty)
    row.add("uncertainty_percent", 100 * std::abs(*entry.scale_uncertainty / *entry.scale));
  add_zero(row, entry);
  row.add("unit", entry.unit);
  if (!entry.notes.empty()) row.add("notes", entry.notes);
  return row;
}

}  // namespace

Result<cli::Report> describe_calibration(const std::string& path) {
  const auto file = read_calibration(path);
  TACTO_TRY(file);
  warn_of_unknown(path, *file);
  cli::Report report = report_of(FileKind::calibration, path, file->simulated);
  report.add("serial", file->serial);
  add_text(report, "device", file->device);
  std::vector<cli::Report> rows;
  for (const CalibrationEntry& entry : file->entries) rows.push_back(row_of(entry));
  return report.add("entries", std::move(rows));
}

}  // namespace tacto::schema
