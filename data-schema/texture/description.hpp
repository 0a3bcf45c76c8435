// SPDX-License-Identifier: GPL-3.0-or-later
// Standard descriptions of textures, and their file NAME.descriptions.json.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// A one-third-octave band of spatial frequency: 10^(number / 10) /mm.
struct ThirdOctaveBand {
  int number = 0;
  double centre_per_m = 0;
  double low_per_m = 0, high_per_m = 0;  ///< edges of the whole band
  bool partial = false;                  ///< cut by the valid band: `rms` is that of the valid part
  double rms = 0;                        ///< in the texture's unit
  double density = 0;                    ///< mean power spectral density of the valid part, unit^2 m
};

/// One texture in a few numbers, within [low_per_m, high_per_m].
struct Description {
  std::string texture;  ///< its name
  std::string quantity, unit;
  double length_m = 0, pitch_m = 0;
  double from_m = 0, to_m = 0;           ///< the described part, at steady speed
  double mean_speed_mps = 0;             ///< of the recording; 0 where unknown
  double low_per_m = 0, high_per_m = 0;  ///< valid along all of it, and resolved by the window
  double window_m = 0;
  double rms = 0;        ///< in the texture's unit
  double total_rms = 0;  ///< of its samples, valid or not
  double centroid_per_m = 0;
  double slope_db_per_octave = 0;  ///< NaN if less than an octave is valid
  std::vector<ThirdOctaveBand> bands;
  std::string simulated;  ///< by what, where it is simulated
};

struct DescriptionFile {
  std::vector<Description> textures;
  std::string created, creator;
  std::string extra_json;
  std::string newer_version;
  std::vector<std::string> unknown_members = {};
};

/// NAME.descriptions.json, by stem or in full. Errors: not_found; malformed; unsupported_version.
Result<DescriptionFile> read_descriptions(const std::string& name);

/// The file's text. Errors: unsuitable, where the schema does not allow it.
Result<std::string> descriptions_json(const DescriptionFile& file);

/// A table for other programs: one row a texture, units in the headers, one column for each band that any
/// texture has; a partial band has its value in the column "... partial" beside it.
std::string descriptions_csv(const DescriptionFile& file);

}  // namespace tacto::schema
