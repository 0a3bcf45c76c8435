// SPDX-License-Identifier: GPL-3.0-or-later
// The Bode plot of an identification: data, model with its confidence band, inverse, residuals.
#pragma once

#include <string>
#include <vector>

#include "analysis/identify/fit/response_fit.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::analysis {

/// dB re the model's gain at 0 Hz (for a sensor re its largest gain). The whitened residuals have a part
/// along the model (amplitude) and a part across it (phase). The 95 % band is empty if the fit has no
/// intervals.
struct BodeCurves {
  std::vector<double> model_db, low_db, high_db, inverse_db, model_deg, inverse_deg;  ///< at curve_hz
  std::vector<double> data_db, data_deg, along, across;  ///< at the data's frequencies
};

BodeCurves bode_curves(const ResponseFit& fit);

/// Three panels over frequency: amplitude in dB re the model's at 0 Hz (for a sensor re its largest), phase
/// in degrees, whitened residuals. The inverse is the drive per displacement that playback has to give, re
/// its value at 0 Hz.
struct BodeFigure : spatial::Figure {
  explicit BodeFigure(const ResponseFit& of) : fit(of) {}
  spatial::Size page() const override;
  schema::Result<void> draw(spatial::Canvas& canvas) const override;
  const ResponseFit& fit;
};

}  // namespace tacto::analysis
