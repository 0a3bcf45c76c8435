// SPDX-License-Identifier: GPL-3.0-or-later
// The playback choices as lines of a report.
#pragma once

#include "data-schema/report/report.hpp"
#include "data-schema/scene/playback_choices.hpp"

namespace tacto::cli {

/// The choices that are set, under their names in files.
inline void add_choices(Report& report, const schema::PlaybackChoices& choices) {
  for (const auto& [name, member] : schema::kChosenWords)
    if (choices.*member) report.add(name, *(choices.*member));
  for (const auto& [name, member] : schema::kChosenNumbers)
    if (choices.*member) report.add(name, *(choices.*member));
}

}  // namespace tacto::cli
