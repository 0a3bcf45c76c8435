// SPDX-License-Identifier: GPL-3.0-or-later
// What a spectrogram of a texture errs, by what people read from it; the rows that say so.
#pragma once

#include <string>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/spectrogram/spectrogram_options.hpp"

namespace tacto::analysis {

/// A window of 5 mm: of a texture from 12 mm on there are some rows.
spatial::SpectrogramOptions standard_spectrogram(const schema::Texture& texture);

/// As fine as rows are taken where "every" is asked for.
spatial::SpectrogramOptions with_every_row(spatial::SpectrogramOptions options,
                                           const schema::Texture& texture);

/// Cost in ns a sample of the texture, memory of the cells.
TradeRow spectrogram_row(const schema::Texture& texture, const spatial::SpectrogramOptions& options,
                         std::string knob, std::string choice, const schema::Spectrogram& made, double error);

/// The power of each row, straight between rows, against that of all rows of the same window: RMS re RMS.
double error_between_rows(const schema::Spectrogram& made, const schema::Spectrogram& every);

/// The height of each row's highest peak, as an amplitude, its mean; re that of `finest`. Both: density.
double error_of_peaks(const schema::Spectrogram& made, const schema::Spectrogram& finest);

/// Where the octaves end whose energy is asked for, 1/m.
inline constexpr double kOctaves_per_m[] = {500, 1000, 2000, 4000, 8000};

/// The mean power of each octave, unit^2, in the rows between two places: the density, straight between its
/// bins, integrated from one end of the octave to the other. Where it is even or goes straight along
/// frequency this is exact whatever the padding; whole bins would be one too many or too few.
std::vector<double> octave_powers(const schema::Spectrogram& made, double from_m, double to_m);

/// The energy by octaves of the texture's middle, by filters in space: the truth for spectrograms of density.
class OctaveEnergy {
 public:
  /// Errors: of filter_in_space.
  static schema::Result<OctaveEnergy> of(const schema::Texture& texture);
  /// RMS over the octaves of what is off, re theirs.
  double error(const schema::Spectrogram& made) const;

 private:
  double from_m_ = 0, to_m_ = 0;
  std::vector<double> truth_;
};

}  // namespace tacto::analysis
