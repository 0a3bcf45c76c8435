// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's scale by a known pull that is let go.
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

/// A pull that ends is a step, |F(f)| = force / (2 pi f), and the transducer answers M(f) = F(f) times its
/// response over its nominal gain. Over 0.5 s around the largest sample, from 10 to 60 Hz in steps of 2 Hz
/// (orthogonal over 0.5 s, no window: it begins and ends at rest), c = sum |X| |M| / sum |M|^2 is how much
/// the channel gives of what it should, and the scale is the device's own over c. Uncertainty: of one release
/// what the fit leaves; of several also their scatter, whichever is larger, and all forces' common relative
/// uncertainty. What a thread adds that does not part at once, is not in it: repeat it. Errors: usage: no
/// such channel, no force; unsuitable: no transducer, no release that stands out, too near an end, clipped.
schema::Result<ReleasedScale> scale_by_releases(std::span<const Release> releases, const std::string& channel,
                                                double relative_force_uncertainty);

}  // namespace tacto::capture
