// SPDX-License-Identifier: GPL-3.0-or-later
// A texture as the page needs it: frames of the wire, a picture's numbers, the modelled tray.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/link/client.hpp"
#include "playback/player/program.hpp"

namespace tacto::analysis {

using Frame = std::vector<std::uint8_t>;  ///< of the wire

struct LiveTexture {
  std::string file;  ///< the sidecar
  playback::Program program;
  /// The frames of playback::upload() to the page's board, each as it was accepted.
  std::vector<Frame> upload;
  double rms = 0;  ///< of the texture, about its mean
  /// Of the texture in kMapColumns equal parts of its length: the least and the greatest value of each.
  std::vector<float> map;
  /// The tray's displacement, m, for a drive of 1 V in one tick, from that tick on: the transducer's linear
  /// model, with the converter's hold.
  std::vector<float> tray;
  std::string session_stem = {};  ///< what the names of its sessions begin with
};

inline constexpr std::size_t kMapColumns = 2000;
/// 32 ms: the response of the preset's tray (547 Hz, quality 5.2) has fallen by 92 dB then.
inline constexpr std::size_t kTrayTaps = 512;

/// The frames that `send` sends to the page's board, each as it was accepted. The board has a tray, or with
/// `axes` these axes at this rate. `name`: for errors. Errors: those of `send`, at `name`.
schema::Result<std::vector<Frame>> frames_of(
    const std::string& name, const std::function<schema::Result<void>(firmware_host::Client&)>& send,
    const wire::Axes* axes = nullptr, std::uint32_t rate_hz = 0);

/// `inverse` of the transducer: a word of PlaybackChoices, or the default. Errors: as make_program and
/// upload.
schema::Result<LiveTexture> make_live_texture(const std::string& file, const std::string& transducer,
                                              const std::optional<std::string>& inverse = std::nullopt);

/// Another texture that the page's board plays next.
struct LiveChange {
  std::vector<Frame> frames;       ///< before the command that changes to it
  schema::SessionProgram program;  ///< for the session
};
/// The change from `playing`, which the board got at rest, to `next`, whose samples are multiplied by
/// `times`. Errors: as check_texture_change.
schema::Result<LiveChange> make_change(const LiveTexture& playing, const LiveTexture& next, double times);

/// LiveTexture::map, in so many parts.
std::vector<float> texture_map(const std::vector<double>& values, std::size_t columns = kMapColumns);

/// About their mean, which no drive has.
double rms_about_mean(std::vector<double> values);

/// The impulse response of the tray at the page's rate.
std::vector<float> tray_response(const schema::Transducer& transducer);

}  // namespace tacto::analysis
