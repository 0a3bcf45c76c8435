// SPDX-License-Identifier: GPL-3.0-or-later
// The spectrogram options that several verbs have in common.
#pragma once

#include "data-schema/command/verb.hpp"
#include "spatial/spectrogram/spectrogram.hpp"

namespace tacto::spatial {

/// --window, --hop and --max-frequency.
inline void declare_spectrogram(CLI::App& app, SpectrogramOptions& options) {
  using schema::Dimension;
  cli::add_quantity(app, "--window", options.window_m, Dimension::length, "Length of the Blackman window");
  cli::add_quantity(app, "--hop", options.hop_m, Dimension::length, "Distance from one window to the next");
  cli::add_quantity(app, "--max-frequency", options.max_frequency_per_m, Dimension::spatial_frequency,
                    "Highest spatial frequency that is analysed");
}

}  // namespace tacto::spatial
