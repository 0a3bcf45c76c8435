// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/sections.hpp"

#include <algorithm>
#include <numbers>

#include "spatial/dsp/record_ends.hpp"

namespace tacto::spatial {
namespace {

// Transposed direct form II: the two delays of one section.
struct Delays {
  double z1 = 0, z2 = 0;
};

double tick(const Section& s, Delays& d, double input) {
  const double output = s.b0 * input + d.z1;
  d.z1 = s.b1 * input - s.a1 * output + d.z2;
  d.z2 = s.b2 * input - s.a2 * output;
  return output;
}

// Each section as if `value` had been coming in for ever.
std::vector<Delays> steady_state(std::span<const Section> sections, double value) {
  std::vector<Delays> delays;
  for (const Section& s : sections) {
    const double output = value * (s.b0 + s.b1 + s.b2) / (1 + s.a1 + s.a2);
    delays.push_back({output - s.b0 * value, s.b2 * value - s.a2 * output});
    value = output;
  }
  return delays;
}

template <class Iterator>
void run(std::span<const Section> sections, Iterator first, Iterator last) {
  std::vector<Delays> delays = steady_state(sections, *first);
  for (; first != last; ++first)
    for (std::size_t s = 0; s < sections.size(); ++s) *first = tick(sections[s], delays[s], *first);
}

}  // namespace

std::complex<double> Section::response(double frequency_hz, double sample_rate_hz) const {
  const std::complex<double> back = std::polar(1.0, -2 * std::numbers::pi * frequency_hz / sample_rate_hz);
  return (b0 + back * (b1 + back * b2)) / (1.0 + back * (a1 + back * a2));
}

std::complex<double> response_of(std::span<const Section> sections, double frequency_hz,
                                 double sample_rate_hz) {
  std::complex<double> product = 1;
  for (const Section& s : sections) product *= s.response(frequency_hz, sample_rate_hz);
  return product;
}

std::size_t default_padding(std::span<const Section> sections) {
  const auto short_numerators = std::ranges::count(sections, 0.0, &Section::b2);
  const auto short_denominators = std::ranges::count(sections, 0.0, &Section::a2);
  const auto fewer = static_cast<std::size_t>(std::min(short_numerators, short_denominators));
  return 3 * (2 * sections.size() + 1 - fewer);
}

std::vector<double> filter_zero_phase(std::span<const Section> sections, std::span<const double> values,
                                      std::size_t padding) {
  if (values.empty()) return {};
  padding = std::min(padding, values.size() - 1);
  std::vector<double> extended = extend_odd(values, padding);
  run(sections, extended.begin(), extended.end());
  run(sections, extended.rbegin(), extended.rend());
  const auto first = extended.begin() + static_cast<std::ptrdiff_t>(padding);
  return {first, first + static_cast<std::ptrdiff_t>(values.size())};
}

}  // namespace tacto::spatial
