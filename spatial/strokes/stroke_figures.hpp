// SPDX-License-Identifier: GPL-3.0-or-later
// The strokes of a recording in the form in which its sidecar stores them.
#pragma once

#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::spatial {

/// The strokes that `spatial` finds; none without a position, or if the position never changes.
/// `clipped_samples` is not filled in. `lost_frames` are missing within a stroke (bridge_short_gaps), or
/// directly before or after it. Reads the position as TouchRecord::open. Errors: of reading.
schema::Result<std::vector<schema::StrokeFigures>> stroke_figures(const schema::Recording& recording);

}  // namespace tacto::spatial
