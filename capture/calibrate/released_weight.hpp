// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's scale from the release of a known force.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"

namespace tacto::capture {

/// One release: frames in which a thread with a weight was cut once, and the weight's force.
struct Release {
  Take take;
  double force_n = 0;
};

struct ReleasedScale {
  Uncertain scale;  ///< N per stored number, at the channel's nominal frequency of 100 Hz
  std::vector<std::string> notes;
};

/// A force that ends suddenly is a step, |F(f)| = force / (2 pi f). The expected spectrum is M(f) = F(f)
/// times the transducer's response over its nominal gain; X(f) is the measured one. Both are compared over
/// 0.5 s around the largest sample, from 10 to 60 Hz in steps of 2 Hz (orthogonal over 0.5 s; no window,
/// because the signal is at rest at both ends): c = sum |X| |M| / sum |M|^2, and the scale is the nominal
/// scale over c. Uncertainty: for one release the residual of the fit, for several the larger of that and
/// their scatter; and the relative uncertainty that all forces share. The error of a thread that does not
/// break at once is not included: repeat the release. Errors: usage: no such channel, no force; unsuitable:
/// no transducer, no release above the noise, a release too near an end, clipped.
schema::Result<ReleasedScale> scale_by_releases(std::span<const Release> releases, const std::string& channel,
                                                double relative_force_uncertainty);

}  // namespace tacto::capture
