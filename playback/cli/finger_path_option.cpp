// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/finger_path_option.hpp"

namespace tacto::playback {

schema::Result<FingerPath> FingerPathOption::read() const {
  auto path = read_finger_path(file);
  if (!path || repeats == 1) return path;
  return repeated(*path, repeats);
}

CLI::Option* declare_finger_path(CLI::App& app, FingerPathOption& option, const std::string& of_what) {
  CLI::Option* const path =
      app.add_option("--finger-path", option.file,
                     of_what +
                         "CSV with the columns time and position, with their units in the header, as "
                         "in time_s,position_mm; optionally normal_force_N");
  app.add_option("--repeat", option.repeats,
                 "How many times the finger follows the path: each time from its beginning if it ends where "
                 "it began (within 1um), else back and forth")
      ->check(cli::from_one())
      ->needs(path)
      ->capture_default_str();
  return path;
}

}  // namespace tacto::playback
