// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.descriptions.json, read and written, and their table as CSV.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "data-schema/base/table_text.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/texture/description.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kDescriptionsKind = "descriptions";

struct Number {
  const char* name;
  double Description::*member;
};

constexpr Number kDescriptionNumbers[] = {
    {"length_m", &Description::length_m},
    {"from_m", &Description::from_m},
    {"to_m", &Description::to_m},
    {"pitch_m", &Description::pitch_m},
    {"mean_speed_mps", &Description::mean_speed_mps},
    {"low_per_m", &Description::low_per_m},
    {"high_per_m", &Description::high_per_m},
    {"window_m", &Description::window_m},
    {"rms", &Description::rms},
    {"total_rms", &Description::total_rms},
    {"centroid_per_m", &Description::centroid_per_m},
    {"slope_db_per_octave", &Description::slope_db_per_octave},
};

Json band_body(const ThirdOctaveBand& band) {
  return {{"number", band.number},         {"centre_per_m", band.centre_per_m}, {"low_per_m", band.low_per_m},
          {"high_per_m", band.high_per_m}, {"partial", band.partial},           {"rms", band.rms},
          {"density", band.density}};
}

ThirdOctaveBand band_from(const Json& body) {
  return {body["number"].get<int>(),       body["centre_per_m"].get<double>(),
          number_or(body, "low_per_m", 0), number_or(body, "high_per_m", 0),
          body["partial"].get<bool>(),     body["rms"].get<double>(),
          number_or(body, "density", 0)};
}

Json description_body(const Description& description) {
  Json body = {
      {"texture", description.texture}, {"quantity", description.quantity}, {"unit", description.unit}};
  put_text(body, "simulated", description.simulated);
  for (const auto& [name, member] : kDescriptionNumbers)
    if (std::isfinite(description.*member)) body[name] = description.*member;
  body["bands"] = Json::array();
  for (const ThirdOctaveBand& band : description.bands) body["bands"].push_back(band_body(band));
  return body;
}

Description description_from(const Json& body) {
  Description description;
  description.texture = text_or(body, "texture");
  description.quantity = text_or(body, "quantity");
  description.unit = text_or(body, "unit");
  description.simulated = text_or(body, "simulated");
  for (const auto& [name, member] : kDescriptionNumbers) description.*member = number_or(body, name, NAN);
  for (const Json& band : body["bands"]) description.bands.push_back(band_from(band));
  return description;
}

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

Result<DescriptionFile> read_descriptions(const std::string& name) {
  const auto document =
      open_document(stem_of(name, ".descriptions") + ".descriptions.json", kDescriptionsKind);
  TACTO_TRY(document);
  DescriptionFile file;
  for (const Json& each : document->body["textures"]) file.textures.push_back(description_from(each));
  file.created = text_or(document->body, "created");
  file.creator = text_or(document->body, "creator");
  keep_unknown(*document, file);
  return file;
}

Result<std::string> descriptions_json(const DescriptionFile& file) {
  Json body = {{"textures", Json::array()}};
  for (const Description& each : file.textures) body["textures"].push_back(description_body(each));
  put_text(body, "created", file.created);
  put_text(body, "creator", file.creator);
  return document_text(kDescriptionsKind, body, file.extra_json);
}

std::string descriptions_csv(const DescriptionFile& file) {
  const auto bands = all_bands(file);
  std::string text = header(bands, file.textures.empty() ? "" : file.textures.front().unit);
  for (const Description& each : file.textures) text += row(each, bands);
  return text;
}

}  // namespace tacto::schema
