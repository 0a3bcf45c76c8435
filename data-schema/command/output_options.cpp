// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/output_options.hpp"

namespace tacto::cli {

void declare_force(CLI::App& app, schema::Existing& existing) {
  existing = schema::Existing::keep;
  app.add_flag_callback(
      "--force", [&existing] { existing = schema::Existing::replace; },
      "Replace files that have the names of outputs (never a recording, nor a file of another kind)");
}

void declare_unfit_transducer(CLI::App& app, bool& taken) {
  app.add_flag("--unfit-transducer", taken, "Take a transducer whose file says that its model does not fit");
}

void refuse_force(CLI::App& app) {
  const auto refuse = [] {
    throw CLI::ValidationError("--force",
                               "this verb replaces no files; a transducer whose model does not fit is taken "
                               "with --unfit-transducer");
  };
  app.add_flag_callback("--force", refuse)->group("");  // not shown
}

}  // namespace tacto::cli
