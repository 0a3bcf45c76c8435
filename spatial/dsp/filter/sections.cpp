// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/sections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "spatial/dsp/filter/record_ends.hpp"

namespace tacto::spatial {
namespace {

// Sections that run at once: four are enough to use the processor fully, and their state fits its registers.
constexpr std::size_t kAtOnce = 4;
// Longer chains process so many values at a time, which stay in the cache.
constexpr std::size_t kSectionBlock = 2048;

double slowest_pole(const Section& s) {
  const double square = s.a1 * s.a1 / 4 - s.a2;
  return square < 0 ? std::sqrt(s.a2) : std::abs(s.a1) / 2 + std::sqrt(square);
}

// `count` sections over values first, first + step ... ; the delays stay in registers.
template <std::size_t count, std::ptrdiff_t step, class Delays>
void run_sections(const Section* sections, Delays* delays, double* first, std::size_t size) {
  std::array<Section, count> s;
  std::array<Delays, count> d;
  std::copy_n(sections, count, s.begin());
  std::copy_n(delays, count, d.begin());
  for (std::size_t i = 0; i < size; ++i) {
    double& place = first[static_cast<std::ptrdiff_t>(i) * step];
    double value = place;
    for (std::size_t k = 0; k < count; ++k) {
      const double output = s[k].b0 * value + d[k].z1;
      d[k].z1 = (s[k].b1 * value + d[k].z2) - s[k].a1 * output;
      d[k].z2 = s[k].b2 * value - s[k].a2 * output;
      value = output;
    }
    place = value;
  }
  std::ranges::copy(d, delays);
}

template <std::ptrdiff_t step, class Delays>
void run_chain(std::span<const Section> sections, Delays* delays, double* first, std::size_t size) {
  const Section* section = sections.data();
  for (std::size_t left = sections.size(); left > 0;) {
    const std::size_t count = std::min(left, kAtOnce);
    const auto run = count == 4   ? run_sections<4, step, Delays>
                     : count == 3 ? run_sections<3, step, Delays>
                     : count == 2 ? run_sections<2, step, Delays>
                                  : run_sections<1, step, Delays>;
    run(section, delays, first, size);
    section += count;
    delays += count;
    left -= count;
  }
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

SectionChain::SectionChain(std::span<const Section> sections)
    : sections_(sections.begin(), sections.end()), delays_(sections.size()) {}

void SectionChain::settle(double value) {
  for (std::size_t k = 0; k < sections_.size(); ++k) {
    const Section& s = sections_[k];
    const double output = value * (s.b0 + s.b1 + s.b2) / (1 + s.a1 + s.a2);
    delays_[k] = {output - s.b0 * value, s.b2 * value - s.a2 * output};
    value = output;
  }
}

void SectionChain::run(std::span<double> values) {
  for (; !values.empty(); values = values.subspan(std::min(kSectionBlock, values.size())))
    run_chain<1>(sections_, delays_.data(), values.data(), std::min(kSectionBlock, values.size()));
}

void SectionChain::run_backwards(std::span<double> values) {
  for (; !values.empty(); values = values.first(values.size() - std::min(kSectionBlock, values.size())))
    run_chain<-1>(sections_, delays_.data(), &values.back(), std::min(kSectionBlock, values.size()));
}

std::size_t SectionChain::memory(double share) const {
  double slowest = 0;
  for (const Section& s : sections_) slowest = std::max(slowest, slowest_pole(s));
  if (slowest <= 0) return 2 * sections_.size();
  // Close poles of several sections decay more slowly together than one of them.
  const double samples = std::log(share) / std::log(std::min(slowest, 1 - 1e-12));
  return static_cast<std::size_t>(1.5 * samples) + 2 * sections_.size();
}

std::vector<double> filter_zero_phase(std::span<const Section> sections, std::span<const double> values,
                                      std::size_t padding) {
  if (values.empty()) return {};
  padding = std::min(padding, values.size() - 1);
  std::vector<double> extended = extend_odd(values, padding);
  SectionChain chain(sections);
  chain.settle(extended.front());
  chain.run(extended);
  chain.settle(extended.back());
  chain.run_backwards(extended);
  extended.erase(extended.begin(), extended.begin() + static_cast<std::ptrdiff_t>(padding));
  extended.resize(values.size());
  return extended;
}

}  // namespace tacto::spatial
