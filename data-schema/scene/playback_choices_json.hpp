// SPDX-License-Identifier: GPL-3.0-or-later
// The object `playback` of scenes, requests, configurations and sessions.
#pragma once

#include "data-schema/json/json_document.hpp"
#include "data-schema/scene/playback_choices.hpp"

namespace tacto::schema {

/// Precondition: it fits the schemas' definition.
PlaybackChoices playback_choices_from(const Json& body);
/// Only the members that are set.
Json playback_choices_body(const PlaybackChoices& choices);
/// Of the member `playback`, if there is one.
PlaybackChoices playback_choices_in(const Json& document);

}  // namespace tacto::schema
