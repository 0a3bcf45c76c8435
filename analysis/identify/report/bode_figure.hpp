// SPDX-License-Identifier: GPL-3.0-or-later
// The Bode plot of an identification: data, model with its confidence band, inverse, residuals.
#pragma once

#include <string>

#include "analysis/identify/fit/response_fit.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::analysis {

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
