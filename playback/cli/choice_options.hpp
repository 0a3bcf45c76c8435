// SPDX-License-Identifier: GPL-3.0-or-later
// --interpolation, --inverse, --reconstruction and so on, alike in play, explain and ctl.
#pragma once

#include <string>

#include "data-schema/command/verb.hpp"
#include "data-schema/scene/playback_choices.hpp"

namespace tacto::playback {

/// `of_what` begins each help, as in "load: ". `choices` must outlive the parser.
void declare_choices(CLI::App& app, schema::PlaybackChoices& choices, const std::string& of_what = "");

}  // namespace tacto::playback
