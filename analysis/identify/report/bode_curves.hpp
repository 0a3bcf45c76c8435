// SPDX-License-Identifier: GPL-3.0-or-later
// A fit's response, its inverse and what it leaves, in dB and degrees.
#pragma once

#include <vector>

#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// dB re the model's gain at rest (of a sensor re its largest); residuals over their noise, along the model
/// (amplitude) and across it (phase). The 95 % band is empty where none is claimed.
struct BodeCurves {
  std::vector<double> model_db, low_db, high_db, inverse_db, model_deg, inverse_deg;  ///< along curve_hz
  std::vector<double> data_db, data_deg, along, across;  ///< at the data's frequencies
};

BodeCurves bode_curves(const ResponseFit& fit);

}  // namespace tacto::analysis
