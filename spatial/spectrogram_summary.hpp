// SPDX-License-Identifier: GPL-3.0-or-later
// What a spectrogram says in a few numbers: its mean spectrum, its strongest peak, its power in a band.
#pragma once

#include <string>
#include <vector>

#include "data-schema/spectrogram.hpp"

namespace tacto::spatial {

/// The mean over positions of each bin's density, unit^2 m; `bins` values.
std::vector<double> mean_spectrum(const schema::Spectrogram& spectrogram);

struct SpectralPeak {
  double position_m = 0;
  double frequency_per_m = 0;
  double density = 0;  ///< unit^2 m
};

/// The largest cell at or above a frequency. Precondition: the spectrogram has a cell.
SpectralPeak strongest_peak(const schema::Spectrogram& spectrogram, double min_frequency_per_m);

/// Square root of the mean spectrum's integral from a frequency up to the last bin, in the texture's unit.
double band_rms(const schema::Spectrogram& spectrogram, double min_frequency_per_m);

/// Width of the rectangle that passes as much noise as one bin of the Blackman window: 1.7268 / window, 1/m
/// (Harris 1978, table 1). Lines that are closer than this melt into one.
double resolution_per_m(const schema::SpectrogramHeader& spectrogram);

/// The unit in which levels are given, with what brings cells (unit^2 m, or unit of amplitudes) to it.
struct LevelReference {
  std::string unit;       ///< "1 N^2 mm", of amplitudes "1 N"; "1 um^2 mm" for heights and positions
  double factor = 1;      ///< cells to it
  double decade_db = 10;  ///< 10 for densities, which are powers; 20 for amplitudes
};
LevelReference level_reference(const schema::SpectrogramHeader& spectrogram);

/// A cell over the reference in dB; -infinity for no power.
double level_db(double cell, const LevelReference& reference);

}  // namespace tacto::spatial
