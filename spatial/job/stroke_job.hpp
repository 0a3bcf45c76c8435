// SPDX-License-Identifier: GPL-3.0-or-later
// A stroke or section that is to become a texture.
#pragma once

#include <string>

#include "spatial/strokes/strokes.hpp"

namespace tacto::spatial {

struct StrokeJob {
  Stroke stroke;
  int number = 0;    ///< 0 for a section
  std::string stem;  ///< of the texture
};

}  // namespace tacto::spatial
