// SPDX-License-Identifier: GPL-3.0-or-later
// Import of a height profile, measured in space, as a texture of heights.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/import/import.hpp"
#include "capture/table/source.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/exchange/x3p_file.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::capture {

/// A roughness that a file states before its table, as "Ra,56.1,nm" or "Rq (um) = 0,312", and that of the
/// heights: Ra is the mean, Rq the root mean square of the distances from their least-squares line (ISO
/// 4287), without a roughness filter.
struct StatedRoughness {
  std::string name;
  double stated_m = 0, computed_m = 0;
  bool agrees = false;  ///< within half of the last stated digit and kRoughnessTolerance
};

/// Heights on an even grid, and the description in their file.
struct HeightProfile {
  double pitch_m = 0;
  double origin_m = 0;  ///< position of the first height
  int direction = 1;    ///< -1: it was measured backwards and has been reversed
  std::vector<double> height_m;
  double unevenness_m = 0;     ///< the largest deviation of a position from the grid
  std::string surface, notes;  ///< the object and the author of the measurement, lines before a table
  std::vector<StatedRoughness> roughness = {};  ///< of the lines before a table
};

/// Whether the file is a surface or profile of ISO 25178-72, by its ending .x3p.
bool is_x3p(const std::string& file);

/// Whether the request is for a profile in space and not a recording in time: an XML or X3P file, a pitch, or
/// a height and a position without a rate and without a time column.
bool is_profile_request(const ImportRequest& request);

/// Reads a line of an X3P file (schema::read_x3p), all of it or request.points, the XML of the National
/// Physical Laboratory's profiles (DATA/DATAFILE: UNITS, NUMPOINTS, SPACING, DATA_POINT_VALUES), or a table
/// with a height channel and either a position channel or request.pitch_m. Errors: usage (options that do not
/// agree); not_found; malformed, with line and column, or with the XML's element; unsuitable, with the line,
/// for positions that do not change, that reverse, or that deviate from the even grid by more than
/// kMostUnevenness, and for points of an X3P file without a height, with the longest section that has none.
schema::Result<HeightProfile> read_height_profile(const ImportRequest& request,
                                                  const std::function<void(double)>& progress);

/// Heights far from zero lose their roughness in 32 bits: then their mean is subtracted, if the step of a
/// float at the largest height is above 1 % of the RMS about the mean. The note that says so, or "".
std::string subtract_mean(std::vector<double>& heights_m);

/// All points of an X3P file. Errors: usage (options of tables); as schema::read_x3p(); unsuitable, for
/// points without a height, with their number, rows and columns.
schema::Result<schema::X3pHeights> read_x3p_surface(const ImportRequest& request, std::uint64_t most_points);

struct ImportedProfile {
  HeightProfile profile;
  std::string stem;
};

/// Reads the profile and writes STEM.texture.wav and STEM.texture.json: quantity height, metres, known band 0
/// to half a cycle per sample. The mean is subtracted, with a note, if the texture's 32 bits would round the
/// heights by more than 1 % of their RMS. Errors: as read_height_profile(); usage, if the texture exists and
/// not request.replace, or for an option that a texture does not store; unsuitable, for a pitch that no WAV
/// can store; cannot_write.
schema::Result<ImportedProfile> import_profile(const ImportRequest& request,
                                               const std::function<void(double)>& progress);

}  // namespace tacto::capture
