// SPDX-License-Identifier: GPL-3.0-or-later
// The spectrogram of a texture for the page, and its files as `tactograph spectrogram` writes them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

struct LiveSpectrogram {
  schema::Texture texture;
  schema::Spectrogram spectrogram;
  std::vector<schema::Formant> formants;
};

/// 64 MB; a texture of 6 m has as many.
inline constexpr std::size_t kMostLiveCells = std::size_t{1} << 24;

/// With the verb's own defaults. Errors: as read_texture, spatial_spectrogram and find_formants; unsuitable,
/// for more than kMostLiveCells.
schema::Result<LiveSpectrogram> make_live_spectrogram(const std::string& file);

/// For the page, a JSON object: axes, units, range of colours and lower limit of the picture, formants.
std::string spectrogram_json(std::size_t made, const LiveSpectrogram& live);

/// As in the file NAME.nc: rows by position, in its unit.
std::vector<float> stored_cells(const schema::Spectrogram& spectrogram);

/// The valid band of each row, 1/m: lower and upper limit. Empty if the texture states none.
std::vector<float> known_limits(const schema::Spectrogram& spectrogram);

/// What of a spectrogram a file contains; what is absent is not limited.
struct SpectrogramPart {
  std::optional<double> from_m, to_m;  ///< of the positions: windows whose centre is within
  /// Lower end of a picture; its upper end, and the highest frequency of a table.
  std::optional<double> low_per_m, high_per_m;
  double range_db = 60;   ///< between the darkest and the brightest colour of a picture
  bool formants = false;  ///< drawn in a picture
};

/// Reads "from_m=0.01&to_m=0.02". Errors: usage, for an unknown name or what is not a number.
schema::Result<SpectrogramPart> parse_spectrogram_part(const std::string& query);

/// The bytes of a file .png, .svg, .csv or .nc (`form`, without the dot). Without limits they are those that
/// `tactograph spectrogram` writes. Errors: not_found, for another form; unsuitable, for fewer than two
/// windows or hardly any frequencies; of the figure and the writers.
schema::Result<std::string> spectrogram_file(const LiveSpectrogram& live, const SpectrogramPart& part,
                                             const std::string& form);

}  // namespace tacto::analysis
