// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical stability far from usual inputs: each condition is compared with an exact result.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tacto::analysis {

/// One condition and its result.
struct Extreme {
  std::string room;       ///< the folder of the tested method
  std::string condition;  ///< how the input differs from usual ones
  std::string reference;  ///< the exact result
  double error = 0;       ///< re the largest (or, if the condition says so, the RMS) of the exact result
  double most = 0;        ///< largest permitted error, as stated by the method's documentation
  std::string note;       ///< the limit of the method and its message beyond it, or other observations

  bool holds() const { return error <= most; }
  /// 20 log10(most / error), dB.
  double margin_db() const;
};

/// Receives the completed fraction, 0 to 1.
using ExtremesProgress = std::function<void(double)>;

/// capture: codes, clocks, counters, numbers in tables.
std::vector<Extreme> capture_extremes();
/// spatial's filters: rates, edges, steps, sizes.
std::vector<Extreme> filter_extremes();
/// spatial's resampling: grids, offsets, forces, strokes. `all`: a stroke of 1e8 samples (takes a minute)
/// instead of 3e6.
std::vector<Extreme> space_extremes(bool all);
/// playback's inverse: unusual transducers.
std::vector<Extreme> inverse_extremes();
/// The tick kernel: rates, counts, speeds, gains, silence. One row is the duration of a tick, the only row
/// that depends on the machine.
std::vector<Extreme> kernel_extremes();
/// Force scenes: limits of stability, forces of the kernel.
std::vector<Extreme> scene_extremes();

/// spatial's spectrogram: frequencies, offsets.
std::vector<Extreme> spectrum_extremes();
/// The spectrogram's formants: close lines, lines at band edges and on slopes, sizes of force.
std::vector<Extreme> formant_extremes();
/// identify and compare: unusual transducers, unusual levels.
std::vector<Extreme> identify_compare_extremes();

/// All rooms.
std::vector<Extreme> all_extremes(bool all, const ExtremesProgress& progress = {});

}  // namespace tacto::analysis
