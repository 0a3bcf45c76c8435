// SPDX-License-Identifier: GPL-3.0-or-later
// What users choose of how a texture is read, undone and held back, and the options that it becomes.
#pragma once

#include <string_view>

#include "data-schema/scene/playback_choices.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// "full", "magnitude", "gain", "none".
std::string_view to_string(Inverse inverse);

/// The options with what was chosen; what was not stays. A contact without its lower threshold lets go at
/// four fifths of the upper one: a finger's tremor at the threshold does not chatter. Errors: usage, for a
/// word that there is none of, by its member.
schema::Result<PrepareOptions> with_choices(PrepareOptions options, const schema::PlaybackChoices& choices);

/// Whether what somebody said tells more of what is there: a cut-off of a filter, a window of an energy
/// limit, a lower threshold of a contact. `all` is what was said, over what stands below it. Errors: usage,
/// by option and member.
schema::Result<void> check_meant(const schema::PlaybackChoices& said, const schema::PlaybackChoices& all);

/// All that these options come to, for files and reports: energy and contact only where there are such.
schema::PlaybackChoices choices_in(const PrepareOptions& options);

}  // namespace tacto::playback
