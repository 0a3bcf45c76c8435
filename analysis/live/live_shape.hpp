// SPDX-License-Identifier: GPL-3.0-or-later
// What the sliders of the pages make: a texture of the folder in a band and stretched, or a computed one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "data-schema/report/report.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

struct LiveShape {
  double stretch = 1;       ///< factor of all periods
  bool keep_slope = false;  ///< values times `stretch`, too
  std::optional<double> low_per_m, high_per_m;
  // Of computed textures; the defaults give forces as those of the demo's surfaces.
  double period_m = 2e-3;  ///< of noise: of its lowest octave
  double depth_m = 10e-6;  ///< from the lowest place to the highest one
  double duty = 0.5;       ///< share of a period that is high
  double smooth_m = 1e-4;  ///< sigma of the Gaussian filter of the edges
  double slope_db = -6;    ///< amplitude of the heights, from each octave to the next
  double seed = 1;
};

/// Reads "stretch=1.3&keep_slope=1". Errors: usage, for an unknown name, what is not a number, or a number
/// out of its range, with the range.
schema::Result<LiveShape> parse_shape(const std::string& query);

/// A texture, the ending of its name, and what it has of what was asked for: numbers under their names.
struct ShapedTexture {
  schema::Texture texture;
  std::string ending;
  cli::Report effective;
};

/// As `tactograph transform FILE --band --stretch`. Errors: as of these functions.
schema::Result<ShapedTexture> shaped_texture(const std::string& file, const LiveShape& shape);

/// 40 mm, on a grid of 5 um, of grooves or noise of height h(x), as patches have them along x
/// (force_layer.hpp): force = kappa dh/dx, with kappa = 0.5 N, the finger's load (kTargetLoad_n).
ShapedTexture grating_texture(const LiveShape& shape);
/// Octaves down to 0.2 mm. A section through the noise that is nowhere on its lattice.
ShapedTexture noise_texture(const LiveShape& shape);

}  // namespace tacto::analysis
