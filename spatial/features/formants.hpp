// SPDX-License-Identifier: GPL-3.0-or-later
// Spatial formants (Wiertlewski, Lozada and Hayward 2011): regions of high energy in position and spatial
// frequency, as ridges with strength, width and extent. Offline; not safe in the tick.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

struct FormantOptions {
  /// Prominence over the background, in dB, that a ridge reaches at least once ...
  double start_db = 13;
  /// ... and that each of its points has (hysteresis: Canny 1986).
  double go_on_db = 8;
  /// Shortest ridge, and longest gap in one that is bridged; unless told, half a window each.
  std::optional<double> shortest_m, bridge_m;
};

/// The ridges of a spectrogram, strongest first, found within the band that is known at each row (all of
/// it where the spectrogram does not say).
///   Points: maxima along frequency, placed by a parabola through the levels of three bins; they stand
///     go_on_db above the background, and 6 dB above the lowest level within four bins of the unpadded window
///     (4 / window) on both sides, so that the skirt of a line that begins is none, and at most 55 dB under
///     the strongest cell of its row, so that no side lobe of the window is one.
///   Background: spectrogram_background().
///   Ridges: points of neighbouring rows, nearest first, at most half the resolution apart.
///   Extent: at each end, a ridge is cut back to where it lies at most 6 dB under its strongest level within
///     one window: a line that begins at once has half its amplitude where the window's middle meets its
///     beginning.
/// Stated errors, for a line 20 dB above the background at the default options (measured in
/// tests/spatial/formants_test.cpp): mean frequency within 0.02 of a bin of the unpadded window (1 / window),
/// extent of a line that begins and ends at once within 0.15 of the window. False alarms: white noise gives
/// at most one ridge in 10 m of texture up to 15 /mm with a window of 10 mm.
/// Errors: usage (thresholds that are not finite or go_on_db above start_db, negative lengths); unsuitable
/// (no row, amplitudes).
schema::Result<std::vector<schema::Formant>> find_formants(const schema::Spectrogram& spectrogram,
                                                           const FormantOptions& options = {});

/// The same with what they were found with, for storing.
schema::Result<schema::FormantTable> formant_table(const schema::Spectrogram& spectrogram,
                                                   const FormantOptions& options = {});

}  // namespace tacto::spatial
