// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's scale from comparison with a load cell under it, in the band that both measure.
#pragma once

#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"

namespace tacto::capture {

struct ReferenceScale {
  Uncertain scale;                  ///< N per stored number, at the channel's nominal frequency of 100 Hz
  double ratio = 1;                 ///< relative to the nominal scale of the device
  double coherence = 0;             ///< the smallest coherence of the bins in use
  double extrapolated_percent = 0;  ///< change of the fitted line over f^2 between 0 Hz and the highest bin
  std::vector<std::string> notes;
};

/// `channel` is the channel of the piezo, `reference` a calibrated channel of the same force;
/// `reference_scale` is its scale, with uncertainty. Any force with energy between 15 and 61 Hz is suitable:
/// a sliding finger, taps. The bins are 2 Hz apart; Hann windows of 1 s overlap by half. The spectrum of the
/// piezo is divided by the transducer's response over its nominal gain. H1 = S_xy / S_xx with the piezo as x:
/// its noise is much smaller, and the noise of the reference averages out. A load cell is slow: the effects
/// of its low-pass and of its held samples are even in f. So ln |H1| is fitted by a + b f^2, weighted by 2 n
/// gamma^2 / (1 - gamma^2) (Bendat and Piersol, Random Data, table 9.6), and the result is a. For a
/// first-order low-pass at 200 Hz this leaves an error of 5e-4. Uncertainty: that of the fit, times the
/// square root of chi^2 / (degrees of freedom) if that is above 1, combined with that of the reference.
/// Errors: usage: no such channels; unsuitable: no transducer, less than 5 s, fewer than 6 bins of coherence
/// 0.5, opposite signs, or a channel that is clipped.
schema::Result<ReferenceScale> scale_by_reference(const Take& take, const std::string& channel,
                                                  const std::string& reference,
                                                  const Uncertain& reference_scale);

}  // namespace tacto::capture
