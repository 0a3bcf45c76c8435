// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/spectrum/window.hpp"

#include <cmath>
#include <numbers>

#include "data-schema/base/raised_cosine.hpp"

namespace tacto::spatial {

std::vector<double> blackman(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t n = 0; n < length; ++n) {
    const double phase = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(length);
    window[n] = 0.42 - 0.5 * std::cos(phase) + 0.08 * std::cos(2 * phase);
  }
  return window;
}

std::vector<double> hann(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t n = 0; n < length; ++n)
    window[n] =
        schema::rising_cosine(2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(length));
  return window;
}

}  // namespace tacto::spatial
