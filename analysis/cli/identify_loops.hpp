// SPDX-License-Identifier: GPL-3.0-or-later
// `identify` by slow loops: alone, and together with a sweep.
#pragma once

#include "analysis/cli/identify_options.hpp"

namespace tacto::analysis {

/// Of a device or a table: the hysteresis alone.
schema::Result<cli::Report> identify_loops(const IdentifyOptions& options, IdentifySource& source);
/// Of a device: a sweep and slow loops, fitted together.
schema::Result<cli::Report> identify_jointly(const IdentifyOptions& options, IdentifySource& source);

}  // namespace tacto::analysis
