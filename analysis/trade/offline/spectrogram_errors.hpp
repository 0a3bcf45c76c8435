// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of a texture's spectrogram in the quantities that are read from it, and the rows with them.
#pragma once

#include <string>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/spectrogram/spectrogram_options.hpp"

namespace tacto::analysis {

/// A window of 5 mm, so that textures from 12 mm on give some rows.
spatial::SpectrogramOptions standard_spectrogram(const schema::Texture& texture);

/// Sets the smallest hop, for the reference with every row.
spatial::SpectrogramOptions with_every_row(spatial::SpectrogramOptions options,
                                           const schema::Texture& texture);

/// Cost in ns per sample of the texture; memory of the cells.
TradeRow spectrogram_row(const schema::Texture& texture, const spatial::SpectrogramOptions& options,
                         std::string knob, std::string choice, const schema::Spectrogram& made, double error);

/// The power of each row, interpolated linearly between rows, against all rows of the same window: RMS re
/// RMS.
double error_between_rows(const schema::Spectrogram& made, const schema::Spectrogram& every);

/// The mean height of the highest peak of each row, as an amplitude, re that of `finest`. Both: density.
double error_of_peaks(const schema::Spectrogram& made, const schema::Spectrogram& finest);

/// Limits of the octaves for the energy, 1/m.
inline constexpr double kOctaves_per_m[] = {500, 1000, 2000, 4000, 8000};

/// The mean power of each octave, unit^2, in the rows between two places: the density, linear between its
/// bins, is integrated over the octave. For a constant density or a straight slope this is exact with any
/// padding; a sum over whole bins would have up to one bin too many or too few.
std::vector<double> octave_powers(const schema::Spectrogram& made, double from_m, double to_m);

/// The energy by octaves in the texture's middle, by filters in space: the reference for density
/// spectrograms.
class OctaveEnergy {
 public:
  /// Errors: those of filter_in_space.
  static schema::Result<OctaveEnergy> of(const schema::Texture& texture);
  /// RMS over the octaves of the error, re the RMS of the reference.
  double error(const schema::Spectrogram& made) const;

 private:
  double from_m_ = 0, to_m_ = 0;
  std::vector<double> truth_;
};

}  // namespace tacto::analysis
