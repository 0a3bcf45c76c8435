// SPDX-License-Identifier: GPL-3.0-or-later
// Draws one texture's panel of a spectrogram figure.
#pragma once

#include <span>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/draw/heading.hpp"
#include "spatial/picture/heatmap.hpp"
#include "spatial/picture/spectrogram_layout.hpp"

namespace tacto::spatial {

/// The inputs and steps of the drawing. Axes in mm and 1/mm, placed on the panel's spectrogram.
struct PanelPainter {
  Canvas& canvas;
  const schema::Texture& texture;
  const schema::Spectrogram& spectrogram;
  const Heading& heading;
  PanelLayout layout;
  Axis position;
  Axis frequency;
  LevelRange levels;
  std::span<const schema::Formant> formants;

  /// Errors: those of heatmap().
  schema::Result<void> paint();

 private:
  void paint_trace();
  schema::Result<void> paint_heat();
  void paint_wavelengths();
  void paint_mean();
  void paint_bar();
  void paint_notes();
};

/// Name, surface, method and, for simulated data, their source.
Heading panel_heading(const schema::Texture& texture, const schema::Spectrogram& spectrogram);

/// Window, hop, bins, speed, direction and band in one line.
std::string method_facts(const schema::Texture& texture, const schema::Spectrogram& spectrogram);

}  // namespace tacto::spatial
