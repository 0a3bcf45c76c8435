// SPDX-License-Identifier: GPL-3.0-or-later
// Rounds the paths of an SVG to the visible decimals.
#pragma once

#include <string>
#include <string_view>

namespace tacto::spatial {

/// The SVG with the numbers of its paths (attribute d) rounded to 0.01 of a point, a fiftieth of a PNG's
/// pixel. Cairo writes six decimals, which are half of the bytes of a picture of curves.
std::string with_rounded_paths(std::string_view svg);

}  // namespace tacto::spatial
