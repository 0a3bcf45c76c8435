// SPDX-License-Identifier: GPL-3.0-or-later
// The cheapest way from a recording to a texture that keeps a promise, by what was measured.
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

/// The stages of the table that are chosen here.
inline constexpr const char* kResamplingStage = "resampling";
inline constexpr const char* kGridStage = "grid";
inline constexpr const char* kSpectrogramStage = "spectrogram";

/// The grids that are tried, m.
inline constexpr double kGrids_m[] = {0.5e-6, 1e-6, 2e-6, 5e-6, 10e-6, 20e-6};

/// What a texture is made from, and what of the choice is made already.
struct TextureNeed {
  double sample_rate_hz = 0, highest_hz = 0;  ///< of the recording; the band's upper edge
  double slowest_mps = 0;                     ///< mean speed of the slowest stroke
  std::optional<ResampleMethod> method;
  std::optional<double> pitch_m;
};

/// The speed down to which a promise reaches, re the stroke's mean: at lower ones the band reaches finer than
/// any grid, and the texture's valid band says how far.
inline constexpr double kPromisedSpeed = 0.5;

/// And to speeds whose changes take so many frames or more, there and back: 10 ms at 10 kHz. Faster ones bend
/// the path between two positions more than was measured.
inline constexpr double kSteadyFrames = 100;

struct TextureChoice {
  ResampleMethod method = ResampleMethod::hermite;
  double pitch_m = 1e-6;
  double error = 0;          ///< RMS of what is off, re the force's RMS, at most
  double cost_ns_per_m = 0;  ///< CPU time a metre of stroke
  double bytes_per_m = 0;
};

struct TextureChoices {
  TextureChoice taken;
  std::vector<TextureChoice> tried;  ///< all there are, the cheapest first
};

/// The error counts what method and grid lose of the force in its band, read between the grid's points by
/// cubic Hermite (playback's way): the sum of both, each as of a sine at the band's upper edge, which is an
/// upper bound where the rest lies below it, and a tenth more. It doesn't count the encoder's rounding and
/// noise, what the band-pass takes (band_share), and places where the finger is slower than kPromisedSpeed.
/// Errors: unsuitable, where no choice keeps the promise (with the least error there is), or the table lacks
/// a stage.
schema::Result<TextureChoices> choose_texture(const schema::TradeTable& table, const TextureNeed& need,
                                              const schema::Budget& budget);

struct ResolutionChoice {
  Resolution resolution = Resolution::automatic;
  double error = 0;  ///< largest |X - exact X| re the largest |X|
  double cost_ns_per_cell = 0;
};

/// The resolution on which a spectrogram is computed, of those or of the one that is named. Window, hop and
/// padding say what is asked for, and are never chosen. Errors: as choose_texture.
schema::Result<std::vector<ResolutionChoice>> resolutions_of(const schema::TradeTable& table);
schema::Result<ResolutionChoice> choose_resolution(const schema::TradeTable& table,
                                                   std::optional<Resolution> named,
                                                   const schema::Budget& budget);

}  // namespace tacto::spatial
