// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's scale against a load cell under it, in the band that both can hear.
#pragma once

#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"

namespace tacto::capture {

struct ReferenceScale {
  Uncertain scale;                  ///< N per stored number, at the channel's nominal frequency of 100 Hz
  double ratio = 1;                 ///< against the device's own scale
  double coherence = 0;             ///< smallest of the bins used
  double extrapolated_percent = 0;  ///< what the line over f^2 adds between 0 Hz and the highest bin
  std::vector<std::string> notes;
};

/// `channel` is the piezo's, `reference` a channel of the same force that is calibrated: `reference_scale`
/// and its relative uncertainty. Any pull will do that has something between 15 and 61 Hz: a sliding finger,
/// taps. Bins 2 Hz apart, Hann windows of 1 s that overlap by half; the piezo's spectrum is divided by the
/// transducer's response over its nominal gain; H1 = S_xy / S_xx with the piezo as x, whose noise is the
/// smaller by far, so that the reference's falls out. A load cell is slow: its low-pass and its being held
/// are even in f, so ln |H1| is fitted by a + b f^2, weighted by 2 n gamma^2 / (1 - gamma^2) (Bendat and
/// Piersol, Random Data, table 9.6), and a is the answer. For a first-order low-pass at 200 Hz what that
/// leaves out is 5e-4. Uncertainty: the fit's, times the root of chi^2 over its degrees of freedom where
/// above 1, with the reference's own. Errors: usage: no such channels; unsuitable: no transducer, less than
/// 5 s, not enough coherence (0.5) in 6 bins, the two of opposite signs, or either clipped.
schema::Result<ReferenceScale> scale_by_reference(const Take& take, const std::string& channel,
                                                  const std::string& reference,
                                                  const Uncertain& reference_scale);

}  // namespace tacto::capture
