// SPDX-License-Identifier: GPL-3.0-or-later
// The two limits of a pass band in Hz.
#pragma once

namespace tacto::spatial {

/// Passes low_hz <= f <= high_hz, both limits included. The default is the transducer's useful band
/// (Wiertlewski 2011).
struct Band {
  double low_hz = 15;
  double high_hz = 500;
  bool contains(double frequency_hz) const { return frequency_hz >= low_hz && frequency_hz <= high_hz; }
};

}  // namespace tacto::spatial
