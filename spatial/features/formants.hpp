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
  /// Prominence over the background, in dB, that at least one point of a ridge reaches.
  double start_db = 13;
  /// Prominence, in dB, that all of its points reach (hysteresis: Canny 1986).
  double continue_db = 8;
  /// Shortest ridge, and longest gap in a ridge that is bridged. Default: half a window each.
  std::optional<double> shortest_m, bridge_m;
};

/// The ridges of a spectrogram, strongest first, within the band that is known at each row (the whole
/// spectrum if the spectrogram has no known band).
///   Points: maxima along frequency, placed by a parabola through the levels of three bins. They are at least
///     continue_db above the background. They are also at least 6 dB above the lowest level within four bins
///     of the unpadded window (4 / window) on each side, which excludes the skirt of a line that begins, and
///     at most 55 dB below the strongest cell of their row, which excludes side lobes of the window.
///   Background: spectrogram_background().
///   Ridges: points of neighbouring rows, nearest first, at most half the resolution apart.
///   Extent: each end of a ridge is cut back to the first point that is at most 6 dB below the strongest
///     level within one window, because a line that begins abruptly has half its amplitude where the window's
///     middle is at its beginning.
/// Stated errors, for a line 20 dB above the background with the default options (measured in
/// tests/spatial/formants_test.cpp): mean frequency within 0.02 of a bin of the unpadded window (1 / window),
/// extent of a line that begins and ends abruptly within 0.15 of the window. False alarms: white noise gives
/// at most one ridge in 10 m of texture up to 15 /mm with a window of 10 mm. Errors: usage (thresholds that
/// are not finite, continue_db above start_db, negative lengths); unsuitable (no row, amplitudes instead of
/// densities).
schema::Result<std::vector<schema::Formant>> find_formants(const schema::Spectrogram& spectrogram,
                                                           const FormantOptions& options = {});

/// The same as a table that also has the options, for storing.
schema::Result<schema::FormantTable> formant_table(const schema::Spectrogram& spectrogram,
                                                   const FormantOptions& options = {});

}  // namespace tacto::spatial
