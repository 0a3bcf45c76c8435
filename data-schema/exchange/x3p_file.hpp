// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces and profiles of ISO 25178-72 (.x3p).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// A line of a surface: one of the first two, counted from 1; or all of it. A profile needs no choice.
struct X3pChoice {
  std::optional<std::uint64_t> row;     ///< along x
  std::optional<std::uint64_t> column;  ///< along y
  std::optional<std::uint64_t>
      most_points;  ///< without row and column: the whole surface, of at most so many
};

/// Heights along a line, or row by row of a surface, in metres; NaN where a point has none.
struct X3pHeights {
  std::string name;  ///< "row 12 of 100", "the profile", "the surface"
  double pitch_m = 0, origin_m = 0;
  std::size_t rows = 1;
  double row_pitch_m = 0;  ///< of a surface
  std::vector<double> height_m;
  std::string notes;  ///< creator, instrument and date of the file; a checksum that it does not have
};

/// The most bytes of the heights of a file, which are read whole.
inline constexpr std::uint64_t kMostX3pBytes = std::uint64_t{2} << 30;

/// Reads a line or a surface. Of the archive only main.xml, also in a folder of its own, and the files that
/// it names are read. Features SUR and PRF, heights of type I, L, F and D with increment and offset; a point
/// is not valid by the mask, or where its number is not finite. The checksums of main.xml and of the data are
/// compared, if there are some. Sizes are compared before memory is allocated. Errors: not_found; malformed,
/// with the member: cut, damaged, another size or checksum; usage: a line that does not exist, or none of a
/// surface; unsuitable: point clouds, several layers, absolute x, points as text, more than kMostX3pBytes or
/// most_points.
Result<X3pHeights> read_x3p(const std::string& path, const X3pChoice& choice);

}  // namespace tacto::schema
