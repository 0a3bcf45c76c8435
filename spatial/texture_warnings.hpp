// SPDX-License-Identifier: GPL-3.0-or-later
// What a user should know of a texture before trusting it.
#pragma once

#include <string>
#include <vector>

#include "data-schema/texture.hpp"

namespace tacto::spatial {

/// One line each: positions that conditioning had to move further than their quantum and 6 standard
/// deviations of their noise explain (the finger went back); a band whose upper end lies, at the mean speed,
/// beyond what the grid can hold; a counter that ran over.
std::vector<std::string> texture_warnings(const schema::Texture& texture);

}  // namespace tacto::spatial
