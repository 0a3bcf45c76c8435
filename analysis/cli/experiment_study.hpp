// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the verb `experiment` for a study: from its protocol to the proof.
#pragma once

#include "data-schema/command/verb.hpp"

namespace tacto::analysis {

/// Each adds its options to a subcommand and returns the subcommand's action.
cli::Action declare_new_study(CLI::App& app);
cli::Action declare_check_study(CLI::App& app);
cli::Action declare_run_study(CLI::App& app);
cli::Action declare_resume_study(CLI::App& app);
cli::Action declare_prove_run(CLI::App& app);
cli::Action declare_noise(CLI::App& app);
cli::Action declare_watch_study(CLI::App& app);
cli::Action declare_withdraw(CLI::App& app);
cli::Action declare_study_power(CLI::App& app);
cli::Action declare_export_study(CLI::App& app);

}  // namespace tacto::analysis
