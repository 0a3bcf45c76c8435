// SPDX-License-Identifier: GPL-3.0-or-later
// The daemon's current figures as a screen of text.
#pragma once

#include <cstddef>
#include <string>

#include "data-schema/control/control.hpp"

namespace tacto::playback {

/// The lines for a `status`, the most important first.
std::string top_screen(const schema::ControlFields& fields);

/// The lines that fit into a terminal of so many rows, each cut to its columns; the last one without a
/// newline, so that the terminal does not scroll.
std::string clipped_to(const std::string& text, std::size_t rows, std::size_t columns);

}  // namespace tacto::playback
