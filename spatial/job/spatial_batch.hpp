// SPDX-License-Identifier: GPL-3.0-or-later
// `tactograph spatial` on many recordings, some at a time.
#pragma once

#include "data-schema/report/report.hpp"
#include "spatial/job/spatial_options.hpp"

namespace tacto::spatial {

/// Files of other kinds are skipped and named; a recording that fails does not stop the others, is named at
/// the end, and its exit code is the process's (the first one's, of several). Errors: usage, of names;
/// unsuitable, where there is no recording among the files.
schema::Result<cli::Report> spatial_batch(const SpatialOptions& options);

}  // namespace tacto::spatial
