// SPDX-License-Identifier: GPL-3.0-or-later
// Whose gain it is that a texture is played with.
#pragma once

#include <optional>

#include "data-schema/cli/report.hpp"
#include "data-schema/texture.hpp"

namespace tacto::playback {

/// `gain_set_by` and `gain_set_on` of the gain that a texture keeps; nothing of another.
inline void add_kept_gain(cli::Report& report, const std::optional<schema::PlaybackGain>& kept) {
  if (!kept) return;
  report.add("gain_set_by", kept->who.empty() ? "unknown" : kept->who);
  if (!kept->when.empty()) report.add("gain_set_on", kept->when);
}

}  // namespace tacto::playback
