// SPDX-License-Identifier: GPL-3.0-or-later
// The options that several verbs of playback have: --interpolation, --inverse and so on, --ends,
// --finger-path.
#pragma once

#include <optional>
#include <string>

#include "data-schema/command/verb.hpp"
#include "data-schema/scene/playback_choices.hpp"
#include "data-schema/scene/scene.hpp"
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

/// `of_what` is the beginning of the help text, as in "load: ". `ends` must outlive the parser.
void declare_ends(CLI::App& app, std::optional<schema::TextureEnds>& ends, const std::string& of_what = "");

/// `of_what` is the beginning of each help text, as in "load: ". `choices` must outlive the parser.
void declare_choices(CLI::App& app, schema::PlaybackChoices& choices, const std::string& of_what = "");

}  // namespace tacto::playback
