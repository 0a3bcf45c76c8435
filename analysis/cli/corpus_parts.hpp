// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the verb `corpus` for other places: a cluster, an archive of data.
#pragma once

#include "data-schema/command/verb.hpp"

namespace tacto::analysis {

/// Each adds its options to a subcommand and returns the subcommand's action.
cli::Action declare_workflow(CLI::App& app);
cli::Action declare_pack(CLI::App& app);

}  // namespace tacto::analysis
