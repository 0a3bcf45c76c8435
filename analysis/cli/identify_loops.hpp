// SPDX-License-Identifier: GPL-3.0-or-later
// `identify` with slow loops: alone, and together with a sweep.
#pragma once

#include "analysis/cli/identify_options.hpp"

namespace tacto::analysis {

/// Identifies the hysteresis alone, from a device or a table.
schema::Result<cli::Report> identify_loops(const IdentifyOptions& options, IdentifySource& source);
/// Measures a sweep and slow loops on a device and fits them together.
schema::Result<cli::Report> identify_jointly(const IdentifyOptions& options, IdentifySource& source);

}  // namespace tacto::analysis
