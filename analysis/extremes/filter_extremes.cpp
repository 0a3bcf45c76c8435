// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "analysis/extremes/extreme.hpp"
#include "analysis/extremes/rough_signals.hpp"
#include "spatial/dsp/filter/block_fourier_filter.hpp"
#include "spatial/dsp/filter/butterworth.hpp"
#include "spatial/dsp/filter/fourier_filter.hpp"
#include "spatial/reference/exact_treated_band_pass.hpp"
#include "spatial/reference/exact_zero_phase.hpp"

namespace tacto::analysis {
namespace {

using spatial::Band;

constexpr double kFilterPi = std::numbers::pi;
constexpr const char* kExactSections = "zero-phase sections in long double";
constexpr const char* kExactKernel = "the filter's definition, summed in long double";

// Re the largest output value. The reference computes its own filter design, too.
double butterworth_error(std::span<const double> values, int order, Band band, double rate_hz,
                         std::size_t padding) {
  const auto sections = spatial::butterworth_band_pass(order, band, rate_hz);
  const auto exact = spatial::reference::exact_zero_phase(
      spatial::reference::exact_butterworth(order, band, rate_hz), values, padding);
  return largest_difference(spatial::filter_zero_phase(*sections, values, padding), exact) /
         largest_of(exact);
}

// Re the largest output value, at `places` places.
double fourier_error(std::span<const double> values, Band band, double rate_hz, std::size_t places) {
  spatial::BlockFourierFilter filter(rate_hz, band);
  std::vector<double> fast;
  filter.push(values, fast);
  filter.finish(fast);
  const double lowest = std::max(band.low_hz, std::min(band.high_hz, rate_hz / 2) / 512);
  const spatial::reference::ExactTreatedBandPass exact(values, rate_hz, band, lowest, filter.reach_s());
  double error = 0;
  for (std::size_t i = 0; i < places; ++i) {
    const std::size_t index = i * (values.size() - 1) / (places - 1);
    error = std::max(error, std::abs(fast[index] - exact(index)));
  }
  return error / largest_of(fast);
}

// The same 4 s at 1 MHz and at 10 kHz; other tests compare 10 kHz with the definition. The kernel is the same
// in seconds. The signal consists of tones, so that it is the same at both rates, which fade in and out,
// because the end of a record depends on its rate.
double fourier_rate_error() {
  const auto record = [](double rate_hz) {
    std::vector<double> values(static_cast<std::size_t>(4 * rate_hz));
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double t_s = static_cast<double>(i) / rate_hz;
      const double tones = std::sin(2 * kFilterPi * 15.7 * t_s) + std::sin(2 * kFilterPi * 400 * t_s) +
                           std::sin(2 * kFilterPi * 1500 * t_s);
      values[i] = 5 + 3 * t_s + std::pow(std::sin(kFilterPi * t_s / 4), 4) * tones;
    }
    return values;
  };
  const auto fine = spatial::fourier_filter(record(1e6), 1e6, {15, 500}, spatial::Edges::treated);
  const auto coarse = spatial::fourier_filter(record(1e4), 1e4, {15, 500}, spatial::Edges::treated);
  double error = 0;
  for (std::size_t i = 10000; i < 30000; ++i) error = std::max(error, std::abs(fine[100 * i] - coarse[i]));
  return error / largest_of(coarse);
}

// The spacing of denormals is 5e-324; the rounding error of a sum is some thousand of these steps.
void add_forces(std::vector<Extreme>& rows) {
  struct Size {
    double scale, most;
    const char* name;
  };
  for (const auto& [scale, most, name] :
       {Size{1e30, 2e-12, "1e30 N"}, Size{1e-30, 2e-12, "1e-30 N"}, Size{1e-300, 2e-12, "1e-300 N"},
        Size{1e-310, 1e-9, "1e-310 N, denormals"}}) {
    const auto values = rough_values(30000, scale);
    rows.push_back({"spatial",
                    std::string("Butterworth, forces of ") + name,
                    kExactSections,
                    butterworth_error(values, 4, {15, 500}, 1e4, 5333),
                    most,
                    {}});
    rows.push_back({"spatial",
                    std::string("Fourier, forces of ") + name,
                    kExactKernel,
                    fourier_error(values, {15, 500}, 1e4, 40),
                    1e-7,
                    {}});
  }
}

}  // namespace

std::vector<Extreme> filter_extremes() {
  const Band edges{0.5, 499.5};
  std::vector<Extreme> rows{
      {"spatial",
       "Butterworth 15-500 Hz at 1 MHz, order 8",
       kExactSections,
       butterworth_error(rough_values(400000), 8, {15, 500}, 1e6, 200000),
       5e-9,
       {}},
      {"spatial",
       "Butterworth 15-20 Hz at 1 MHz, order 8, a step",
       kExactSections,
       butterworth_error(step_values(400000), 8, {15, 20}, 1e6, 200000),
       5e-7,
       {}},
      {"spatial", "Fourier 15-500 Hz at 1 MHz", "the same at 10 kHz", fourier_rate_error(), 1e-6, {}},
      {"spatial",
       "Butterworth from 0.001 to 0.999 of half the rate, order 8",
       kExactSections,
       butterworth_error(rough_values(100000), 8, edges, 1000, 16000),
       1e-10,
       {}},
      {"spatial",
       "Fourier from 0.001 to 0.999 of half the rate",
       kExactKernel,
       fourier_error(rough_values(200000), edges, 1000, 40),
       1e-11,
       {}},
      {"spatial",
       "Butterworth, a step in 1e6 samples",
       kExactSections,
       butterworth_error(step_values(1000000), 4, {15, 500}, 1e4, 5333),
       1e-12,
       {}},
      {"spatial",
       "Fourier, a step in 1e6 samples",
       kExactKernel,
       fourier_error(step_values(1000000), {15, 500}, 1e4, 41),
       1e-8,
       {}}};
  for (const std::size_t size : {2U, 3U})
    rows.push_back({"spatial",
                    "Butterworth over " + std::to_string(size) + " samples",
                    kExactSections,
                    butterworth_error(rough_values(size), 4, {15, 500}, 1e4, size - 1),
                    1e-9,
                    {}});
  add_forces(rows);
  return rows;
}

}  // namespace tacto::analysis
