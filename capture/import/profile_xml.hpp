// SPDX-License-Identifier: GPL-3.0-or-later
// The XML of the profiles that the National Physical Laboratory publishes. Only this file uses pugixml.
#pragma once

#include <string>

#include "capture/import/height_profile.hpp"

namespace tacto::capture {

/// DATA/DATAFILE: UNITS (a length, of heights and of the spacing), NUMPOINTS, SPACING, DATA_POINT_VALUES;
/// DATA/PART: name, manufacturer and description, kept as surface and notes. Errors: not_found; malformed,
/// with the byte or the element; unsuitable, for profiles that are not 2D.
schema::Result<HeightProfile> read_profile_xml(const std::string& file);

}  // namespace tacto::capture
