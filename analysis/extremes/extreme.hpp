// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical stability far from the usual: each condition against something exact.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tacto::analysis {

/// One condition and what came of it.
struct Extreme {
  std::string room;       ///< the folder whose method it is
  std::string condition;  ///< how far from the usual
  std::string reference;  ///< what is exact
  double error = 0;       ///< re the largest (or, where the condition says so, the RMS) of the exact result
  double most = 0;        ///< it may be: what the method's own text states
  std::string note;       ///< where the method ends and what is said beyond it, or what else was seen

  bool holds() const { return error <= most; }
  /// 20 log10(most / error), dB.
  double margin_db() const;
};

/// Hears how much of all is done, 0 to 1.
using ExtremesProgress = std::function<void(double)>;

/// capture: codes, clocks, counters, numbers of tables.
std::vector<Extreme> capture_extremes();
/// spatial's filters: rates, edges, steps, sizes.
std::vector<Extreme> filter_extremes();
/// spatial's resampling: grids, offsets, forces, strokes. `all`: a stroke of 1e8 samples (a minute) instead
/// of 3e6.
std::vector<Extreme> space_extremes(bool all);
/// playback's inverse: transducers that nobody builds.
std::vector<Extreme> inverse_extremes();
/// The tick kernel: rates, counts, speeds, gains, silence (and, of all rows the only one that is of this
/// machine, how long a tick takes there).
std::vector<Extreme> kernel_extremes();

/// spatial's spectrogram: frequencies, offsets.
std::vector<Extreme> spectrum_extremes();
/// The spectrogram's formants: lines that lie close, at edges, on slopes, and sizes of force.
std::vector<Extreme> formant_extremes();
/// analysis: transducers to identify, levels to compare.
std::vector<Extreme> question_extremes();

/// All rooms.
std::vector<Extreme> all_extremes(bool all, const ExtremesProgress& progress = {});

}  // namespace tacto::analysis
