// SPDX-License-Identifier: GPL-3.0-or-later
// The options of `tactograph spatial`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/command/budget_options.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/files/files.hpp"
#include "spatial/texture/make_texture.hpp"

namespace tacto::spatial {

enum class Align { position, correlation };
enum class BandIn { time, space };

struct SpatialOptions {
  std::vector<std::string> recordings;
  std::string output;
  TextureOptions texture;
  std::optional<ResampleMethod> method;  ///< if they are named
  std::optional<double> pitch_m;
  cli::BudgetOptions chosen_by;
  std::string band;
  BandIn band_in = BandIn::time;
  std::optional<double> low_hz, high_hz, from_s, to_s;
  std::optional<int> stroke;
  bool list = false, finger_up = false, average = false, both_ways = false;
  bool mix = false;  ///< averages different surfaces, or measured with simulated recordings
  schema::Existing existing = schema::Existing::keep;
  schema::Sync sync = schema::Sync::now;
  Align align = Align::position;
  double align_range_m = 0.5e-3;
  int jobs = 1;
};

struct BandLimits {
  double low, high;
};

/// The text of --band: LOW..HIGH, in Hz or in cycles per length. Errors: usage.
schema::Result<BandLimits> parse_band(const std::string& text, schema::Dimension dimension);

/// Declares the options on the verb's parser; `options` must outlive it.
void declare_spatial(CLI::App& app, SpatialOptions& options);

/// The options for textures, from --band, --low and --high, too. Errors: usage.
schema::Result<TextureOptions> texture_options(const SpatialOptions& options);

}  // namespace tacto::spatial
