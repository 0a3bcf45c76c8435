// SPDX-License-Identifier: GPL-3.0-or-later
// The cosine series of a profile of grooves, and the filter that keeps its walls stable.
#pragma once

#include <vector>

#include "data-schema/scene/force_layer.hpp"

namespace tacto::playback {

/// Amplitudes of the harmonics, from the first on, of a profile of depth 1 (from its lowest to its highest
/// place), after a Gaussian filter of `filter_periods` (its standard deviation in periods; 0 for none). Up to
/// core::kMostHarmonics, or up to the last one above 1e-6 of the first. The highest place is at phase 0.
/// `duty`: the share of a period in which a square is high.
std::vector<double> groove_amplitudes(schema::GrooveProfile profile, double filter_periods,
                                      double duty = 0.5);

/// The largest curvature of such a profile, per squared period.
double largest_curvature(const std::vector<double>& amplitudes);

/// The filter_m of grooves for `auto`: filter_margin times the sigma at which kappa times the largest
/// curvature is the stiffness limit (kappa and depth: the upper ends of their sliders). A step smoothed by
/// sigma has the curvature 0.242 depth / sigma^2, the kinks of a triangle 4 depth / period / (sqrt(2 pi)
/// sigma). A sine is not filtered. Of a square at least period / 76: then the harmonics above
/// core::kMostHarmonics are below 1e-6 of the first. Precondition: the limit is above 0.
double automatic_filter_m(const schema::GroovesLayer& grooves, double stiffness_limit_n_per_m);

}  // namespace tacto::playback
