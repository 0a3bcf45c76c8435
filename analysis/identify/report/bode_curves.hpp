// SPDX-License-Identifier: GPL-3.0-or-later
// Bode curves of a fit: response, inverse and residuals, in dB and degrees.
#pragma once

#include <vector>

#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// dB re the model's gain at 0 Hz (for a sensor re its largest gain). The whitened residuals have a part
/// along the model (amplitude) and a part across it (phase). The 95 % band is empty if the fit has no
/// intervals.
struct BodeCurves {
  std::vector<double> model_db, low_db, high_db, inverse_db, model_deg, inverse_deg;  ///< at curve_hz
  std::vector<double> data_db, data_deg, along, across;  ///< at the data's frequencies
};

BodeCurves bode_curves(const ResponseFit& fit);

}  // namespace tacto::analysis
