// SPDX-License-Identifier: GPL-3.0-or-later
// A texture's sidecar as JSON, and the paths of its two files.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "data-schema/texture/texture.hpp"

namespace tacto::schema {

/// The member `data` of the sidecar: the WAV that belongs to it.
struct TextureData {
  std::string file;  ///< no folder
  std::string sha256;
  std::uint64_t samples = 0;
  std::size_t channels = 1;  ///< 2 of an average: mean and standard deviation
};

/// Everything but the samples, under the C++ names; without `kind`, `version` and the texture's extra_json.
nlohmann::ordered_json texture_body(const Texture& texture, const TextureData& data);

/// Reads a document made by texture_body. Precondition: it fits the texture's schema. The signal has its
/// pitch and no values.
Texture texture_from(const nlohmann::ordered_json& body);
TextureData texture_data_from(const nlohmann::ordered_json& body);

/// The member `playback_gain`.
nlohmann::ordered_json playback_gain_body(const PlaybackGain& gain);

}  // namespace tacto::schema
