// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/reference/exact_short_time.hpp"

#include <cmath>
#include <numbers>

namespace tacto::spatial::reference {
namespace {

using Complex = std::complex<long double>;

std::vector<Complex> roots_of_unity(std::size_t length) {
  std::vector<Complex> roots;
  const auto n = static_cast<long double>(length);
  for (std::size_t k = 0; k < length; ++k)
    roots.push_back(std::polar(1.0L, -2 * std::numbers::pi_v<long double> * static_cast<long double>(k) / n));
  return roots;
}

// Transform of x[0], x[stride], x[2 stride] ...; `roots` are those of the whole length.
std::vector<Complex> transform(const long double* x, std::size_t stride, std::span<const Complex> roots) {
  const std::size_t length = roots.size() / stride;
  std::vector<Complex> result(length);
  if (length % 2 == 1) {
    for (std::size_t k = 0; k < length; ++k)
      for (std::size_t n = 0; n < length; ++n) result[k] += x[n * stride] * roots[k * n % length * stride];
    return result;
  }
  const auto even = transform(x, 2 * stride, roots);
  const auto odd = transform(x + stride, 2 * stride, roots);
  for (std::size_t k = 0; k < length / 2; ++k) {
    const Complex turned = odd[k] * roots[k * stride];
    result[k] = even[k] + turned;
    result[k + length / 2] = even[k] - turned;
  }
  return result;
}

long double blackman(std::size_t n, std::size_t length) {
  const long double phase =
      2 * std::numbers::pi_v<long double> * static_cast<long double>(n) / static_cast<long double>(length);
  return 0.42L - 0.5L * std::cos(phase) + 0.08L * std::cos(2 * phase);
}

}  // namespace

std::vector<Complex> exact_fourier(std::span<const long double> x) {
  return transform(x.data(), 1, roots_of_unity(x.size()));
}

std::vector<Complex> exact_short_time_row(std::span<const double> signal, const FrameShape& shape,
                                          std::size_t row, bool detrend) {
  const auto inside = signal.subspan(row * shape.hop, shape.window);
  long double mean = 0;
  if (detrend)
    for (const double value : inside)
      mean += static_cast<long double>(value) / static_cast<long double>(shape.window);
  std::vector<long double> weighted(shape.padded, 0.0L);
  for (std::size_t n = 0; n < shape.window; ++n)
    weighted[n] = blackman(n, shape.window) * (static_cast<long double>(inside[n]) - mean);
  auto spectrum = exact_fourier(weighted);
  spectrum.resize(shape.padded / 2 + 1);
  return spectrum;
}

}  // namespace tacto::spatial::reference
