// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/output_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace tacto::cli {

schema::Result<void> check_ending(const std::string& output, std::initializer_list<std::string_view> endings,
                                  const std::string& remedy) {
  constexpr std::string_view kEndings[] = {".csv", ".h5",  ".html", ".json", ".mat",
                                           ".nc",  ".ods", ".pdf",  ".png",  ".session",
                                           ".svg", ".txt", ".wav",  ".xls",  ".xlsx"};
  const std::string ending = std::filesystem::path(output).extension().string();
  if (std::ranges::find(endings, ending) != endings.end() ||
      std::ranges::find(kEndings, ending) == std::end(kEndings))
    return {};
  return schema::fail(schema::ErrorKind::usage, fmt::format("no file of this kind ends in '{}'", ending),
                      output, remedy);
}

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
