// SPDX-License-Identifier: GPL-3.0-or-later
// The gain that a texture is played with, what its sign does, and whose it is.
#pragma once

#include <optional>

#include "data-schema/report/report.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/model/gain_sign.hpp"

namespace tacto::playback {

/// `gain_m_per_n`, and `inverts_texture` of one below 0.
inline void add_gain(cli::Report& report, double gain_m_per_n) {
  report.add("gain_m_per_n", gain_m_per_n);
  tell_inversion(gain_m_per_n, [&](const char* key, bool value) { report.add(key, value); });
}

/// `gain_set_by` and `gain_set_on` of the gain that a texture keeps; nothing of another.
inline void add_kept_gain(cli::Report& report, const std::optional<schema::PlaybackGain>& kept) {
  if (!kept) return;
  report.add("gain_set_by", kept->who.empty() ? "unknown" : kept->who);
  if (!kept->when.empty()) report.add("gain_set_on", kept->when);
}

}  // namespace tacto::playback
