// SPDX-License-Identifier: GPL-3.0-or-later
// Several axes of a vibration as one signal with the magnitude of their spectra (Landin et al. 2010, DFT321).
#pragma once

#include <span>
#include <vector>

namespace tacto::spatial {

struct Dft321 {
  std::vector<double> values;
  /// |sum_n a_n b_n| / (|a| |b|), of the axes a and the values b: the correlation of the axes with the values
  /// along the direction that fits best. 1 where the direction of the axes' motion stays, about 0.67 where it
  /// turns by half a circle, near 0 where the axes cancel in their sum, from which the phase is taken.
  double waveform_correlation = 1;
};

/// B_k = sqrt(sum_i |A_ik|^2) exp(i arg(sum_i A_ik)) by the discrete Fourier transform of the whole section:
/// the magnitudes are exact, the waveform is not kept. The phase of a bin whose sum is 0 is 0.
/// Preconditions: the axes have the same number of values, at least 1.
/// Source: Landin, Romano, McMahan, Kuchenbecker: Dimensional reduction of high-frequency accelerations for
/// haptic rendering, EuroHaptics 2010.
Dft321 dft321(std::span<const std::span<const double>> axes);

}  // namespace tacto::spatial
