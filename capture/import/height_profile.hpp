// SPDX-License-Identifier: GPL-3.0-or-later
// A height profile measured in space, made a texture of heights.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/import/import.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::capture {

/// How far a position may be from its place on the even grid, in pitches: positions are often printed with
/// few digits. Heights are taken to lie on the grid; further off is no even profile.
inline constexpr double kMostUnevenness = 0.25;

/// Heights on an even grid, and what their file says of them.
struct HeightProfile {
  double pitch_m = 0;
  double origin_m = 0;  ///< position of the first height
  int direction = 1;    ///< -1: it was measured backwards, and is turned round
  std::vector<double> height_m;
  double unevenness_m = 0;     ///< how far positions were off the grid, at most
  std::string surface, notes;  ///< what was measured, by whom
};

/// Whether what the user asks for is a profile in space, not a recording in time: an XML file, a pitch, or a
/// height and a position without a rate and without a time column.
bool asks_for_profile(const ImportRequest& request);

/// Reads it: the XML of the National Physical Laboratory's profiles (DATA/DATAFILE: UNITS, NUMPOINTS,
/// SPACING, DATA_POINT_VALUES), or a table with a height channel and either a position channel or
/// request.pitch_m. Errors: usage (options that don't fit); not_found; malformed, with line and column, or
/// with the XML's element; unsuitable, for positions that stand, turn or are off the even grid by more than
/// kMostUnevenness, naming the line.
schema::Result<HeightProfile> read_height_profile(const ImportRequest& request,
                                                  const std::function<void(double)>& progress);

struct ImportedProfile {
  HeightProfile profile;
  std::string stem;
};

/// Reads it and writes STEM.texture.wav and STEM.texture.json: quantity height, metres, known from 0 to half
/// a cycle a sample. Errors: as read_height_profile(); usage, where the texture is there and not
/// request.replace; cannot_write.
schema::Result<ImportedProfile> import_profile(const ImportRequest& request,
                                               const std::function<void(double)>& progress);

}  // namespace tacto::capture
