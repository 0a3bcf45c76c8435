// SPDX-License-Identifier: GPL-3.0-or-later
// The option --ends, the same in play, render, explain and ctl.
#pragma once

#include <optional>
#include <string>

#include "data-schema/command/verb.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::playback {

/// `of_what` is the beginning of the help text, as in "load: ". `ends` must outlive the parser.
void declare_ends(CLI::App& app, std::optional<schema::TextureEnds>& ends, const std::string& of_what = "");

}  // namespace tacto::playback
