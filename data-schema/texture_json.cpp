// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/texture_json.hpp"

#include <cmath>

#include "data-schema/certificate_json.hpp"
#include "data-schema/json_document.hpp"

namespace tacto::schema {
namespace {

struct TextMember {
  const char* name;
  std::string Texture::*member;
};

constexpr TextMember kTexts[] = {
    {"simulated", &Texture::simulated}, {"surface", &Texture::surface}, {"subject", &Texture::subject},
    {"finger", &Texture::finger},       {"notes", &Texture::notes},     {"created", &Texture::created},
    {"creator", &Texture::creator},
};

struct SourceText {
  const char* name;
  std::string TextureSource::*member;
};

constexpr SourceText kSourceTexts[] = {
    {"recording", &TextureSource::recording}, {"recording_sha256", &TextureSource::recording_sha256},
    {"method", &TextureSource::method},       {"filter", &TextureSource::filter},
    {"edges", &TextureSource::edges},
};

struct SourceNumber {
  const char* name;
  double TextureSource::*member;
};

constexpr SourceNumber kSourceNumbers[] = {
    {"from_s", &TextureSource::from_s},
    {"to_s", &TextureSource::to_s},
    {"low_hz", &TextureSource::low_hz},
    {"high_hz", &TextureSource::high_hz},
    {"mean_speed_mps", &TextureSource::mean_speed_mps},
    {"min_speed_mps", &TextureSource::min_speed_mps},
    {"max_speed_mps", &TextureSource::max_speed_mps},
    {"position_moved_m", &TextureSource::position_moved_m},
};

Json source_body(const TextureSource& source) {
  Json body = Json::object();
  for (const auto& [name, member] : kSourceTexts) put_text(body, name, source.*member);
  for (const auto& [name, member] : kSourceNumbers) body[name] = source.*member;
  if (source.stroke != 0) body["stroke"] = source.stroke;
  if (source.order != 0) body["order"] = source.order;
  body["equalised"] = source.equalised;
  return body;
}

TextureSource source_from(const Json& body) {
  TextureSource source;
  for (const auto& [name, member] : kSourceTexts) source.*member = text_or(body, name);
  for (const auto& [name, member] : kSourceNumbers) source.*member = number_or(body, name, 0);
  source.stroke = static_cast<int>(number_or(body, "stroke", 0));
  source.order = static_cast<int>(number_or(body, "order", 0));
  source.equalised = body.contains("equalised") && body["equalised"].get<bool>();
  return source;
}

Json band_body(const std::vector<BandPoint>& band) {
  Json body = Json::array();
  for (const BandPoint& point : band)
    body.push_back(
        {{"position_m", point.position_m}, {"low_per_m", point.low_per_m}, {"high_per_m", point.high_per_m}});
  return body;
}

std::vector<BandPoint> band_from(const Json& body) {
  std::vector<BandPoint> band;
  for (const Json& point : body)
    band.push_back({point["position_m"].get<double>(), point["low_per_m"].get<double>(),
                    point["high_per_m"].get<double>()});
  return band;
}

}  // namespace

Json texture_body(const Texture& texture, const TextureData& data) {
  Json body = {{"data", {{"file", data.file}, {"sha256", data.sha256}, {"samples", data.samples}}}};
  body["pitch_m"] = texture.signal.pitch_m;
  body["quantity"] = texture.quantity;
  body["unit"] = texture.unit;
  body["direction"] = texture.direction;
  body["source_origin_m"] = texture.source_origin_m;
  if (!texture.valid_band.empty()) body["valid_band"] = band_body(texture.valid_band);
  // A texture that was drawn or computed, not recorded, names no recording.
  if (!texture.source.recording.empty()) body["source"] = source_body(texture.source);
  for (const auto& [name, member] : kTexts) put_text(body, name, texture.*member);
  if (texture.certificate) body["certificate"] = certificate_body(*texture.certificate);
  return body;
}

Texture texture_from(const Json& body) {
  Texture texture;
  texture.signal.pitch_m = body["pitch_m"].get<double>();
  texture.quantity = text_or(body, "quantity");
  texture.unit = text_or(body, "unit");
  texture.direction = body["direction"].get<int>();
  texture.source_origin_m = number_or(body, "source_origin_m", 0);
  if (body.contains("valid_band")) texture.valid_band = band_from(body["valid_band"]);
  if (body.contains("source")) texture.source = source_from(body["source"]);
  if (body.contains("certificate")) texture.certificate = certificate_from(body["certificate"]);
  for (const auto& [name, member] : kTexts) texture.*member = text_or(body, name);
  return texture;
}

TextureData texture_data_from(const Json& body) {
  const Json& data = body["data"];
  return {text_or(data, "file"), text_or(data, "sha256"), data["samples"].get<std::uint64_t>()};
}

double header_rate_of(double pitch_m) {
  return std::round(1 / pitch_m);
}

}  // namespace tacto::schema
