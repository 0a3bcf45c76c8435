// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the module's table; each is a member of DrawingEngine.
#pragma once

#include "spatial/picture/draw/engine.hpp"

namespace tacto::spatial {

std::unique_ptr<Page> cairo_page(bool png, Size size);
std::string pixels_as_palette_png(const Pixels& pixels);
std::uint32_t shade_pixel(double part);
schema::Result<Pixels> heatmap_pixels(const HeatmapJob& job);

}  // namespace tacto::spatial
