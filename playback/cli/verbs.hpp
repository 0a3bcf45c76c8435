// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of this folder, for the table in tactograph.cpp.
#pragma once

#include "data-schema/command/verb.hpp"

namespace tacto::playback {

extern const cli::Verb kRenderVerb;
extern const cli::Verb kExplainVerb;
extern const cli::Verb kPlayVerb;
extern const cli::Verb kCtlVerb;
extern const cli::Verb kSessionVerb;
extern const cli::Verb kReplayVerb;

}  // namespace tacto::playback
