// SPDX-License-Identifier: GPL-3.0-or-later
// The Butterworth band-pass, designed and run forwards and backwards in extended precision.
#pragma once

#include <span>
#include <vector>

#include "spatial/dsp/filter/band.hpp"
#include "spatial/dsp/filter/sections.hpp"

namespace tacto::spatial::reference {

/// A section, and a chain of them, in long double.
struct ExactSection {
  long double b0, b1, b2, a1, a2;
};

/// The band-pass of butterworth_band_pass(), designed in long double; order 1 ... 20.
std::vector<ExactSection> exact_butterworth(int order, Band band, double sample_rate_hz);

/// The same coefficients in long double.
std::vector<ExactSection> widened(std::span<const Section> sections);

/// filter_zero_phase() in long double; padding < size.
std::vector<double> exact_zero_phase(std::span<const ExactSection> sections, std::span<const double> values,
                                     std::size_t padding);

}  // namespace tacto::spatial::reference
