// SPDX-License-Identifier: GPL-3.0-or-later
// A raster of few colours as a PNG with a palette: a third of the bytes of one with three channels.
#pragma once

#include <string>

#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

/// The same pixels, without loss. Empty where there are more than 256 colours, or libpng refuses.
std::string palette_png(const Pixels& pixels);

}  // namespace tacto::spatial
