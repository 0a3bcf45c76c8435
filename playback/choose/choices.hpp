// SPDX-License-Identifier: GPL-3.0-or-later
// The user's choices of interpolation, inverse, limits and contact gate, and the options for them.
#pragma once

#include <string_view>

#include "data-schema/scene/playback_choices.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// "full", "magnitude", "gain", "none".
std::string_view to_string(Inverse inverse);

/// The options with the user's choices; the rest is not changed. Without a lower threshold, contact ends at
/// four fifths of the upper one, so that a finger's tremor at the threshold does not switch it repeatedly.
/// Errors: usage, for an unknown word, with its member.
schema::Result<PrepareOptions> with_choices(PrepareOptions options, const schema::PlaybackChoices& choices);

/// Checks that each detail belongs to something that is chosen: the cut-off of a filter, the window of an
/// energy limit, the lower threshold of a contact gate. `said` is the request, `all` the request over its
/// defaults. Errors: usage, with option and member.
schema::Result<void> check_consistent(const schema::PlaybackChoices& said,
                                      const schema::PlaybackChoices& all);

/// The choices in these options, for files and reports; energy and contact only if they are used.
schema::PlaybackChoices choices_in(const PrepareOptions& options);

}  // namespace tacto::playback
