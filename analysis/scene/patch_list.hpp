// SPDX-License-Identifier: GPL-3.0-or-later
// The patches of a scene in words, below its picture: place, layers with their numbers, sliders.
#pragma once

#include "data-schema/scene/scene.hpp"
#include "spatial/picture/draw/canvas.hpp"

namespace tacto::analysis {

/// In the order of the scene; texts that are too long for the width wrap. Returns the lower end.
double draw_patch_list(spatial::Canvas& canvas, const schema::Scene& scene, spatial::Point top_left,
                       double width);

}  // namespace tacto::analysis
