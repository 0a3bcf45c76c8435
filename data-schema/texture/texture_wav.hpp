// SPDX-License-Identifier: GPL-3.0-or-later
// The file of a texture's samples.
#pragma once

#include <cmath>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// The rate in the WAV's header: samples per metre, rounded.
inline double header_rate_of(double pitch_m) {
  return std::round(1 / pitch_m);
}

/// The WAV that a texture's sidecar names, and the SHA-256 in the sidecar (which read_texture checks). The
/// WAV may have another name than the sidecar.
struct TextureWav {
  std::string path, sha256;
};

/// By stem, NAME.texture.json or NAME.texture.wav. Errors: as read_texture, of the sidecar.
Result<TextureWav> texture_wav(const std::string& name);

}  // namespace tacto::schema
