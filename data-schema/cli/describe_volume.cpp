// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "data-schema/cli/describe.hpp"

namespace tacto::schema {

void add_volume(cli::Report& report, const Volume& volume) {
  const char* const counts[] = {"values_x", "values_y", "values_z"};
  const char* const spacings[] = {"spacing_x_m", "spacing_y_m", "spacing_z_m"};
  const char* const sizes[] = {"size_x_m", "size_y_m", "size_z_m"};
  for (std::size_t i = 0; i < 3; ++i) report.add(counts[i], volume.samples[i]);
  for (std::size_t i = 0; i < 3; ++i) report.add(spacings[i], volume.spacing_m[i]);
  for (std::size_t i = 0; i < 3; ++i) report.add(sizes[i], 2 * volume.half_size_m()[i]);
  const auto [least, most] = std::ranges::minmax(volume.stored);
  const double least_value = volume.value(least);
  report.add("smallest", least_value).add("largest", volume.value(most));
  report.add("steepest_value_per_m", steepest_per_m(volume, least_value));
}

Result<cli::Report> describe_volume(const std::string& path) {
  const auto volume = read_volume(path);
  TACTO_TRY(volume);
  if (const auto note = unknown_note(path, volume->newer_version, {}); !note.empty()) cli::warn(note);
  cli::Report report = report_of(FileKind::volume, path, "");
  add_volume(report, *volume);
  for (const auto& [key, text] :
       {std::pair{"source", &volume->source}, {"notes", &volume->notes}, {"created", &volume->created}})
    add_text(report, key, *text);
  return report;
}

}  // namespace tacto::schema
