// SPDX-License-Identifier: GPL-3.0-or-later
// `tactograph spatial` for many recordings, some of them in parallel.
#pragma once

#include "data-schema/report/report.hpp"
#include "spatial/job/spatial_options.hpp"

namespace tacto::spatial {

/// Whether there are several recordings, or a folder of them.
bool is_batch(const SpatialOptions& options);

/// A folder stands for its recordings, without its subfolders. Files of other kinds are skipped and reported,
/// and so are strokes and recordings that are too short for a texture: one warning for all of them. A
/// recording that fails does not stop the others. It is reported at the end, in one warning for each cause,
/// and the process has its exit code (the first one's, of several). Errors: usage, of names; not_found;
/// unsuitable, if there is no recording among the files, or if all of them are too short.
schema::Result<cli::Report> spatial_batch(const SpatialOptions& options);

}  // namespace tacto::spatial
