// SPDX-License-Identifier: GPL-3.0-or-later
// The options --interpolation, --inverse, --reconstruction and so on, the same in play, explain and ctl.
#pragma once

#include <optional>
#include <string>

#include "data-schema/command/verb.hpp"
#include "data-schema/scene/playback_choices.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::playback {

/// `of_what` is the beginning of the help text, as in "load: ". `ends` must outlive the parser.
void declare_ends(CLI::App& app, std::optional<schema::TextureEnds>& ends, const std::string& of_what = "");

/// `of_what` is the beginning of each help text, as in "load: ". `choices` must outlive the parser.
void declare_choices(CLI::App& app, schema::PlaybackChoices& choices, const std::string& of_what = "");

}  // namespace tacto::playback
