// SPDX-License-Identifier: GPL-3.0-or-later
// `tactograph spatial` for many recordings, some of them in parallel.
#pragma once

#include "data-schema/report/report.hpp"
#include "spatial/job/spatial_options.hpp"

namespace tacto::spatial {

/// Files of other kinds are skipped and reported. A recording that fails does not stop the others. It is
/// reported at the end, and the process has its exit code (the first one's, of several). Errors: usage, of
/// names; unsuitable, if there is no recording among the files.
schema::Result<cli::Report> spatial_batch(const SpatialOptions& options);

}  // namespace tacto::spatial
