// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of other programs: NRRD (teem.sourceforge.net/nrrd/format.html).
#pragma once

#include <optional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/volume/volume.hpp"

namespace tacto::schema {

/// Whether the name ends in .nrrd.
bool is_nrrd_file(const std::string& path);

struct NrrdVolume {
  Volume volume;
  bool mirrored = false;  ///< the file's axes are left-handed: its third one was turned round
  double rounding = 0;    ///< half a step, where its numbers did not fit 16 bits
};

/// Three axes of whole or decimal numbers up to 64 bits, header and data in one file, raw or gzip. The axes
/// of the grid become x, y and z, also if the file turns them in space; its origin is left out. Whole numbers
/// within 16 bits, or that span no more, stay as they are; others are divided into 65,535 equal steps.
/// `unit_m`: its unit of length if it states none. Sizes are checked before memory is taken for them. Errors:
/// not_found; malformed: no NRRD, a field that is missing or wrong, data that are too short or too long, a
/// broken gzip stream, a number that is not finite; unsuitable: what is not read (dimension, type, encoding,
/// detached data), no spacing, axes not at right angles; check_volume(); usage: no unit, or two.
Result<NrrdVolume> read_nrrd(const std::string& path, std::optional<double> unit_m);

}  // namespace tacto::schema
