// SPDX-License-Identifier: GPL-3.0-or-later
// Heights from a greyscale PNG. Only this file uses libpng.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

struct HeightPng {
  std::size_t columns = 0, rows = 0;
  int bits = 16;                 ///< of a sample in the file
  std::vector<float> of_full{};  ///< row by row, from the lowest row of the picture: 0 black, 1 white
};

/// Whether the file begins as a PNG does.
bool is_png(const std::string& file);

/// The stored samples; gamma and colour profiles are not applied. Errors: not_found; malformed, with libpng's
/// message; unsuitable: colour, transparency, more than schema::kMostHeights samples, fewer than 16 bits
/// unless `allow_8bit`.
schema::Result<HeightPng> read_height_png(const std::string& file, bool allow_8bit);

}  // namespace tacto::capture
