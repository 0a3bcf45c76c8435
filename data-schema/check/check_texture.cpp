// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>

#include "data-schema/check/check_parts.hpp"
#include "data-schema/texture/texture_json.hpp"
#include "data-schema/texture/texture_wav.hpp"

namespace tacto::schema {
namespace {

void add_quantity(const std::string& path, const Texture& texture, std::vector<Finding>& findings) {
  const auto quantity = quantity_named(texture.quantity);
  if (!quantity)
    findings.push_back({path + "#/quantity", quantity.error().what});
  else if (si_symbol(quantity->dimension) != texture.unit)
    findings.push_back({path + "#/unit", fmt::format("{} is in {}, not in {}", texture.quantity,
                                                     si_symbol(quantity->dimension), texture.unit)});
}

void add_band(const std::string& path, const Texture& texture, std::vector<Finding>& findings) {
  for (std::size_t i = 0; i < texture.valid_band.size(); ++i) {
    const BandPoint& point = texture.valid_band[i];
    const std::string where = fmt::format("{}#/valid_band/{}", path, i);
    if (point.high_per_m < point.low_per_m)
      findings.push_back({where, "its upper end is below its lower end"});
    if (i > 0 && point.position_m < texture.valid_band[i - 1].position_m)
      findings.push_back({where + "/position_m", "positions must not decrease"});
  }
}

void add_counts(const std::string& path, const Texture& texture, std::vector<Finding>& findings) {
  if (!texture.average) return;
  const auto& counts = texture.average->counts;
  const auto most = static_cast<int>(texture.average->strokes.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const std::string where = fmt::format("{}#/average/counts/{}", path, i);
    if (counts[i].strokes > most)
      findings.push_back({where + "/strokes", fmt::format("is more than the {} strokes averaged", most)});
    if (i > 0 && counts[i].position_m <= counts[i - 1].position_m)
      findings.push_back({where + "/position_m", "positions must increase"});
  }
}

}  // namespace

std::vector<Finding> check_texture(const std::string& path, const Document& document,
                                   const Progress& progress) {
  const Texture texture = texture_from(document.body);
  std::vector<Finding> findings;
  add_quantity(path, texture, findings);
  add_band(path, texture, findings);
  add_counts(path, texture, findings);
  const TextureData data = texture_data_from(document.body);
  const std::string wav = (std::filesystem::path(path).parent_path() / data.file).string();
  std::vector<Channel> channels(data.channels);
  channels.front().name = texture.quantity;
  if (texture.average) channels.back().name = "standard_deviation";
  const auto more = check_wav({wav, data.sha256, SampleFormat::float32, data.samples,
                               header_rate_of(texture.signal.pitch_m), channels},
                              progress);
  findings.insert(findings.end(), more.begin(), more.end());
  return findings;
}

}  // namespace tacto::schema
