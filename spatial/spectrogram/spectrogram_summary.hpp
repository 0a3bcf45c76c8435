// SPDX-License-Identifier: GPL-3.0-or-later
// Summary values of a spectrogram: its mean spectrum, its strongest peak, its power in a band.
#pragma once

#include <string>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// The mean over positions of each bin's density, unit^2 m; for amplitudes the root of their mean square,
/// unit. `bins` values.
std::vector<double> mean_spectrum(const schema::Spectrogram& spectrogram);

struct SpectralPeak {
  double position_m = 0;
  double frequency_per_m = 0;
  double cell = 0;  ///< in the spectrogram's scaling
};

/// The largest cell at or above a frequency, among those in the valid band of their row. All members are NaN
/// if there is none. Precondition: the spectrogram has a cell.
SpectralPeak strongest_peak(const schema::Spectrogram& spectrogram, double min_frequency_per_m);

/// Square root of the integral of the mean density from a frequency up to the last bin, in the texture's
/// unit.
double band_rms(const schema::Spectrogram& spectrogram, double min_frequency_per_m);

/// Whether a bin is in the valid band of a row; true if the spectrogram states no valid band.
bool is_valid(const schema::SpectrogramHeader& spectrogram, std::size_t row, std::size_t bin);

/// The first bin at or above a frequency, or the last bin if there is none.
std::size_t first_bin(const schema::SpectrogramHeader& spectrogram, double min_frequency_per_m);

/// A cell as density, unit^2 m; for amplitudes A^2 / 2 over resolution_per_m(), twice that at zero and half
/// the sampling frequency.
double power_of(const schema::SpectrogramHeader& spectrogram, std::size_t bin, double cell);

/// Width of the rectangle that passes as much noise as one bin of the Blackman window: 1.7268 / window, 1/m
/// (Harris 1978, table 1; mean of w^2 over the square of the mean of w). Lines that are closer than this are
/// not resolved.
double resolution_per_m(const schema::SpectrogramHeader& spectrogram);

/// Lower limit of the frequencies that a picture should show of a texture: 0.7 of its lowest valid frequency,
/// so that the limit is visible; 100/m without a valid band.
double lowest_of_interest_per_m(const schema::Texture& texture);

/// The lower limit for textures with a common axis: the lowest of theirs, but at least the first bin, because
/// a logarithmic axis has no zero, and at most a tenth of the last one, so that the axis has a length.
double lowest_shown_per_m(double lowest_of_interest_per_m, const schema::SpectrogramHeader& spectrogram);

/// The unit of levels, and the factor that converts cells (unit^2 m, or unit for amplitudes) to it.
struct LevelReference {
  std::string unit;       ///< "1 N^2 mm", for amplitudes "1 N"; "1 um^2 mm" for heights and positions
  double factor = 1;      ///< from cells to the unit
  double decade_db = 10;  ///< 10 for densities, which are powers; 20 for amplitudes
};
LevelReference level_reference(const schema::SpectrogramHeader& spectrogram);

/// A cell re the reference in dB; -infinity for no power.
double level_db(double cell, const LevelReference& reference);

}  // namespace tacto::spatial
