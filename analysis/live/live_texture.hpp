// SPDX-License-Identifier: GPL-3.0-or-later
// A texture as the page needs it: frames of the wire, a picture's numbers, the modelled tray.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "playback/player/program.hpp"

namespace tacto::analysis {

struct LiveTexture {
  std::string file;  ///< the sidecar
  playback::Program program;
  /// The frames of playback::upload() to the page's board, each as it was accepted.
  std::vector<std::vector<std::uint8_t>> upload;
  /// Of the texture in kMapColumns equal parts of its length: the least and the greatest value of each.
  std::vector<float> map;
  /// The tray's displacement, m, for a drive of 1 V in one tick, from that tick on: the transducer's linear
  /// model, with the converter's hold.
  std::vector<float> tray;
};

inline constexpr std::size_t kMapColumns = 2000;
/// 32 ms: the response of the preset's tray (547 Hz, quality 5.2) has fallen by 92 dB then.
inline constexpr std::size_t kTrayTaps = 512;

/// Errors: as make_program and upload.
schema::Result<LiveTexture> make_live_texture(const std::string& file, const std::string& transducer);

/// LiveTexture::map.
std::vector<float> texture_map(const std::vector<double>& values);

/// The impulse response of the tray at the page's rate.
std::vector<float> tray_response(const schema::Transducer& transducer);

}  // namespace tacto::analysis
