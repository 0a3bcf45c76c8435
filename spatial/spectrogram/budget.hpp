// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the cheapest method and grid whose measured errors keep a budget.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/results/budget.hpp"
#include "data-schema/results/trade_table.hpp"
#include "spatial/spectrogram/spectrogram_options.hpp"
#include "spatial/texture/resample.hpp"

namespace tacto::spatial {

/// The stages of the table for which a choice is made here.
inline constexpr const char* kResamplingStage = "resampling";
inline constexpr const char* kGridStage = "grid";
inline constexpr const char* kSpectrogramStage = "spectrogram";

/// The grids that are tried, m.
inline constexpr double kGrids_m[] = {0.5e-6, 1e-6, 2e-6, 5e-6, 10e-6, 20e-6};

/// The requirements on a texture, and the choices that are already made.
struct TextureNeed {
  double sample_rate_hz = 0, highest_hz = 0;  ///< of the recording; the band's upper edge
  double slowest_mps = 0;                     ///< mean speed of the slowest stroke
  std::optional<ResampleMethod> method;
  std::optional<double> pitch_m;
};

/// The promise holds down to this speed, relative to the stroke's mean. At lower speeds the band exceeds what
/// any grid holds; the texture's valid band has the limit.
inline constexpr double kPromisedSpeed = 0.5;

/// The promise holds for speed changes with a period of at least this many frames: 10 ms at 10 kHz. Faster
/// changes bend the path between two positions more than was measured.
inline constexpr double kSteadyFrames = 100;

struct TextureChoice {
  ResampleMethod method = ResampleMethod::hermite;
  double pitch_m = 1e-6;
  double error = 0;          ///< largest RMS of the error, re the force's RMS
  double cost_ns_per_m = 0;  ///< CPU time per metre of stroke
  double bytes_per_m = 0;
};

struct TextureChoices {
  TextureChoice taken;
  std::vector<TextureChoice> tried;  ///< all choices, the cheapest first
};

/// The error is what method and grid lose of the force in its band, if playback interpolates between the
/// grid's points by cubic Hermite. It is the sum of both, each for a sine at the band's upper edge (an upper
/// bound, because the rest is below it), and a tenth more. It does not include the encoder's rounding and
/// noise, what the band-pass removes (band_share), and places where the finger is slower than kPromisedSpeed.
/// Errors: unsuitable, if no choice keeps the budget (with the smallest possible error), or the table lacks a
/// stage.
schema::Result<TextureChoices> choose_texture(const schema::TradeTable& table, const TextureNeed& need,
                                              const schema::Budget& budget);

struct ResolutionChoice {
  Resolution resolution = Resolution::automatic;
  double error = 0;  ///< largest |X - exact X| re the largest |X|
  double cost_ns_per_cell = 0;
};

/// The resolutions at which a spectrogram can be computed, the cheapest first. Window, hop and padding are
/// requirements and never chosen. Errors: as choose_texture.
schema::Result<std::vector<ResolutionChoice>> resolutions_of(const schema::TradeTable& table);
schema::Result<ResolutionChoice> choose_resolution(const schema::TradeTable& table,
                                                   std::optional<Resolution> named,
                                                   const schema::Budget& budget);

}  // namespace tacto::spatial
