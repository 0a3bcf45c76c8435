// SPDX-License-Identifier: GPL-3.0-or-later
// The options --finger-path and --repeat, the same in every verb.
#pragma once

#include <string>

#include "data-schema/command/verb.hpp"
#include "playback/model/finger_path.hpp"

namespace tacto::playback {

struct FingerPathOption {
  std::string file;         ///< empty: none
  std::size_t repeats = 1;  ///< passes along the path

  /// Errors: as read_finger_path, repeated. Precondition: a file.
  schema::Result<FingerPath> read() const;
};

/// Adds both options; returns --finger-path. `of_what` begins its help.
CLI::Option* declare_finger_path(CLI::App& app, FingerPathOption& option, const std::string& of_what);

}  // namespace tacto::playback
