// SPDX-License-Identifier: GPL-3.0-or-later
// The daemon's live figures as a screen of text.
#pragma once

#include <cstddef>
#include <string>

#include "data-schema/control/control.hpp"

namespace tacto::playback {

/// Of a `status`: lines, what matters most first.
std::string top_screen(const schema::ControlFields& fields);

/// The lines that a terminal of so many rows has room for, each cut to its columns; the last one without its
/// newline, so that nothing scrolls.
std::string clipped_to(const std::string& text, std::size_t rows, std::size_t columns);

}  // namespace tacto::playback
