// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.descriptions.json, read and written.
#include <cmath>

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

}  // namespace tacto::schema
