// SPDX-License-Identifier: GPL-3.0-or-later
// A spatial spectrogram: power spectral density of a texture around each position, and its file NAME.nc.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// The content of a cell. density: unit^2 m, one-sided power spectral density. amplitude: unit, a sine of
/// amplitude A that fills the window reads A at its bin.
enum class Scaling { density, amplitude };

/// The valid spatial frequencies at one row.
struct KnownBand {
  double low_per_m = 0;
  double high_per_m = 0;
  bool contains(double frequency_per_m) const {
    return low_per_m <= frequency_per_m && frequency_per_m <= high_per_m;
  }
};

/// The number of rows to make and write at once: an even number, of at most 65,536 cells together (or two
/// rows). The blocks of a netCDF file have about as many.
inline std::size_t rows_at_once(std::size_t bins) {
  constexpr std::size_t kCells = std::size_t{1} << 16;
  return kCells / bins < 2 ? 2 : kCells / bins / 2 * 2;
}

/// All data of a spectrogram except its cells. Row p belongs to position_m[p], bin k to the spatial frequency
/// k * frequency_step_per_m.
struct SpectrogramHeader {
  std::vector<double> position_m;  ///< centres of the windows
  /// One a row, or empty if the texture has no valid band: then all frequencies count as valid.
  std::vector<KnownBand> known;
  std::size_t bins = 0;
  double frequency_step_per_m = 0;
  Scaling scaling = Scaling::density;
  std::string quantity, unit;  ///< of the texture
  std::string window;          ///< "blackman"
  std::string detrend;         ///< "constant" (each window's mean was subtracted) or "none"
  double window_m = 0;
  double hop_m = 0;
  double pitch_m = 0;
  std::size_t padded_samples = 0;
  /// The window's mean, 0.42 for Blackman's: amplitudes were divided by it and by the window's length.
  double coherent_gain = 0;
  std::size_t decimation = 1;  ///< of the grid on which the transform worked; 1: whole resolution
  std::string name;            ///< the texture's
  std::string simulated;       ///< by what, where it is simulated
  std::size_t strokes = 1;     ///< set by the reader: number of spectrograms in the file
  std::string newer_version;   ///< set by the reader if the file's minor version is newer than ours

  double frequency_per_m(std::size_t k) const { return static_cast<double>(k) * frequency_step_per_m; }
  bool knows(std::size_t p, std::size_t k) const {
    return known.empty() || known[p].contains(frequency_per_m(k));
  }
};

struct Spectrogram : SpectrogramHeader {
  std::vector<float> cells;  ///< by `scaling`; position_m.size() rows of `bins`
  float at(std::size_t p, std::size_t k) const { return cells[p * bins + k]; }
};

/// The cells' unit in files, as UDUNITS reads it: densities "N2 mm", "(m/s)2 mm", "mm" for the unit "1";
/// amplitudes "N", "m/s", "1".
std::string cell_unit(const SpectrogramHeader& header);

/// The factor from a cell to that unit.
float cell_factor(Scaling scaling);

/// Writes netCDF-4: variables `density` (unit^2 mm) or `amplitude` (unit), `position` (mm),
/// `spatial_frequency` (1/mm), `known` (0 or 1 a cell: what the recording could know; 1 throughout where its
/// band is not said) and its limits by position `known_from` and `known_to` (1/mm), window and scaling as
/// attributes, and `density_db` or `amplitude_db` (dB, by spatial frequency, then position:
/// the order of a plot) and the attribute `sha256` (spectrogram_sum.hpp); with several, a leading dimension
/// `stroke`, shorter ones ended by NaN. All must share one frequency axis. Errors: cannot_write; unsuitable,
/// where axes differ.
Result<void> write_spectrogram_nc(const std::string& path, std::span<const Spectrogram> spectrograms,
                                  bool compress = false);

/// Reads one spectrogram (0-based) of a file. Errors: not_found, malformed, unsupported_version; unsuitable,
/// if the file has fewer.
Result<Spectrogram> read_spectrogram_nc(const std::string& path, std::size_t stroke = 0);

/// Whether it is netCDF of that kind.
bool is_spectrogram_nc(const std::string& path);

/// A table for other programs: first column position_mm; if the texture has a valid band, known_from_per_mm
/// and known_to_per_mm; then one column a frequency, headed with the cells' unit and the frequency ("N2 mm at
/// 0.25/mm"); several spectrograms are distinguished by a leading column `stroke`. Errors: cannot_write;
/// unsuitable, if axes differ.
Result<void> write_spectrogram_csv(const std::string& path, std::span<const Spectrogram> spectrograms);

}  // namespace tacto::schema
