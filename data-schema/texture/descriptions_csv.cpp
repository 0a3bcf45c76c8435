// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>

#include "data-schema/base/table_text.hpp"
#include "data-schema/texture/description.hpp"

namespace tacto::schema {
namespace {

// Every band that a texture has, by number, with its centre.
std::map<int, double> all_bands(const DescriptionFile& file) {
  std::map<int, double> bands;
  for (const Description& each : file.textures)
    for (const ThirdOctaveBand& band : each.bands) bands[band.number] = band.centre_per_m;
  return bands;
}

std::string header(const std::map<int, double>& bands, const std::string& unit) {
  std::string text = fmt::format(
      "texture,quantity,length_mm,from_mm,to_mm,mean_speed_mm_per_s,low_per_mm,high_per_mm,window_mm,rms "
      "({0}),total rms "
      "({0}),"
      "centroid_per_mm,slope_db_per_octave",
      unit);
  for (const auto& [band, centre_per_m] : bands) {
    const std::string centre = fmt::format("{:.3g}/mm", 1e-3 * centre_per_m);
    text += fmt::format(",rms at {0} ({1}),partial at {0}", centre, unit);
  }
  return text + "\n";
}

std::string row(const Description& each, const std::map<int, double>& bands) {
  std::string text = fmt::format("{},{}", csv_cell(each.texture), csv_cell(each.quantity));
  for (const double value :
       {1e3 * each.length_m, 1e3 * each.from_m, 1e3 * each.to_m, 1e3 * each.mean_speed_mps,
        1e-3 * each.low_per_m, 1e-3 * each.high_per_m, 1e3 * each.window_m, each.rms, each.total_rms,
        1e-3 * each.centroid_per_m, each.slope_db_per_octave})
    text += "," + csv_number(value);
  std::map<int, const ThirdOctaveBand*> own;
  for (const ThirdOctaveBand& band : each.bands) own[band.number] = &band;
  for (const auto& [band, centre_per_m] : bands)
    text +=
        own.contains(band) ? fmt::format(",{},{:d}", csv_number(own[band]->rms), own[band]->partial) : ",,";
  return text + "\n";
}

}  // namespace

std::string descriptions_csv(const DescriptionFile& file) {
  const auto bands = all_bands(file);
  std::string text = header(bands, file.textures.empty() ? "" : file.textures.front().unit);
  for (const Description& each : file.textures) text += row(each, bands);
  return text;
}

}  // namespace tacto::schema
