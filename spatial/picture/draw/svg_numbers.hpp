// SPDX-License-Identifier: GPL-3.0-or-later
// Paths of an SVG with as many decimals as can be seen.
#pragma once

#include <string>
#include <string_view>

namespace tacto::spatial {

/// The SVG with the numbers of its paths (attribute d) rounded to 0.01 of a point, a fiftieth of a PNG's
/// pixel. Cairo writes six decimals, which make half of a picture of curves.
std::string with_rounded_paths(std::string_view svg);

}  // namespace tacto::spatial
