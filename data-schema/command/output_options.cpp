// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/output_options.hpp"

namespace tacto::cli {

void declare_force(CLI::App& app, schema::Existing& existing) {
  existing = schema::Existing::keep;
  app.add_flag_callback(
      "--force", [&existing] { existing = schema::Existing::replace; },
      "Replace existing output files (but no recording, and no file of another kind)");
}

void declare_unfit_transducer(CLI::App& app, bool& taken) {
  app.add_flag("--unfit-transducer", taken, "Accept a transducer whose model, by its file, does not fit");
}

void refuse_force(CLI::App& app) {
  const auto refuse = [] {
    throw CLI::ValidationError("--force",
                               "this verb replaces no files; to accept a transducer whose model does not "
                               "fit, use --unfit-transducer");
  };
  app.add_flag_callback("--force", refuse)->group("");  // not shown
}

}  // namespace tacto::cli
