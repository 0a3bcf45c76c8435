// SPDX-License-Identifier: GPL-3.0-or-later
// Spatial formants: the ridges of textures' spatial spectrograms, and their file NAME.formants.json.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// A ridge at one position.
struct FormantPoint {
  double position_m = 0;
  double frequency_per_m = 0;
  double level_db = 0;       ///< over the table's level_reference
  double prominence_db = 0;  ///< over the background around it
};

/// One ridge: a spatial frequency at which the texture is stronger than around it, along some of its length.
struct Formant {
  double from_m = 0, to_m = 0;  ///< extent
  /// The ridge was still there at the first or last position, so the texture may have more of it.
  bool open_from = false, open_to = false;
  double frequency_per_m = 0;                     ///< mean along the ridge, weighted by power
  double lowest_per_m = 0, highest_per_m = 0;     ///< along the ridge
  double width_per_m = 0;                         ///< between its half-power points; median along the ridge
  double level_db = 0;                            ///< of the mean power along the ridge
  double peak_level_db = 0, peak_position_m = 0;  ///< at its strongest point
  double prominence_db = 0;                       ///< mean along the ridge, of dB
  std::vector<FormantPoint> track;
};

/// The formants of one texture, and the settings with which they were found.
struct FormantTable {
  std::string texture;          ///< its name
  std::string quantity, unit;   ///< of the texture
  std::string level_reference;  ///< "1 N^2 mm"
  double window_m = 0, hop_m = 0;
  double resolution_per_m = 0;  ///< lines closer than this are not separated
  double start_db = 0, go_on_db = 0;
  std::string simulated;  ///< by what, where it is simulated
  std::vector<Formant> formants;
};

struct FormantFile {
  std::vector<FormantTable> tables;
  std::string created, creator;
  std::string extra_json;
  std::string newer_version;
  std::vector<std::string> unknown_members = {};
};

/// NAME.formants.json, by stem or in full. Errors: not_found; malformed; unsupported_version.
Result<FormantFile> read_formants(const std::string& name);

/// The file's text. Errors: unsuitable, where the schema does not allow it.
Result<std::string> formants_json(const FormantFile& file);

/// A table for other programs, one row a formant, units in the headers.
std::string formants_csv(const FormantFile& file);

}  // namespace tacto::schema
