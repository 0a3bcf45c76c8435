// SPDX-License-Identifier: GPL-3.0-or-later
// A spatial spectrogram: power spectral density of a texture around each position, and its file NAME.nc.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "data-schema/error.hpp"

namespace tacto::schema {

/// Density of the square of `quantity` per unit of spatial frequency, one-sided.
/// density[p * bins + k] belongs to position_m[p] and spatial frequency k * frequency_step_per_m, in unit^2
/// m.
struct Spectrogram {
  std::vector<double> position_m;  ///< centres of the windows
  std::size_t bins = 0;
  double frequency_step_per_m = 0;
  std::vector<float> density;
  std::string quantity, unit;  ///< of the texture
  std::string window;          ///< "blackman"
  std::string detrend;         ///< "constant" (each window's mean was taken off) or "none"
  double window_m = 0;
  double hop_m = 0;
  double pitch_m = 0;
  std::size_t padded_samples = 0;
  std::string name;           ///< the texture's
  std::string simulated;      ///< by what, where it is simulated
  std::size_t strokes = 1;    ///< set by the reader: how many spectrograms its file holds
  std::string newer_version;  ///< set by the reader where the file's minor version is newer than ours

  double frequency_per_m(std::size_t k) const { return static_cast<double>(k) * frequency_step_per_m; }
  float at(std::size_t p, std::size_t k) const { return density[p * bins + k]; }
};

/// Writes netCDF-4: variables `density` (unit^2 mm), `position` (mm), `spatial_frequency` (1/mm), window and
/// scaling as attributes; with several, a leading dimension `stroke`, shorter ones ended by NaN. All must
/// share one frequency axis. Errors: cannot_write; unsuitable, where axes differ.
Result<void> write_spectrogram_nc(const std::string& path, std::span<const Spectrogram> spectrograms);

/// Reads one spectrogram (0-based) of a file of ours. Errors: not_found, malformed, unsupported_version;
/// unsuitable, where the file has fewer.
Result<Spectrogram> read_spectrogram_nc(const std::string& path, std::size_t stroke = 0);

/// A table for other programs: first column position_mm, then one column a frequency, headed with the
/// density's unit and the frequency ("N2 mm at 0.25/mm"); several spectrograms are told apart by a leading
/// column `stroke`. Errors: cannot_write; unsuitable, where axes differ.
Result<void> write_spectrogram_csv(const std::string& path, std::span<const Spectrogram> spectrograms);

}  // namespace tacto::schema
