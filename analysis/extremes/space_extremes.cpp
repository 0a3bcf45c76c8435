// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "analysis/extremes/extreme.hpp"
#include "analysis/extremes/rough_signals.hpp"
#include "spatial/dsp/resample/hermite_resampler.hpp"
#include "spatial/reference/exact_hermite.hpp"

namespace tacto::analysis {
namespace {

constexpr double kSpacePi = std::numbers::pi;
constexpr const char* kExactCubic = "the monotone cubic and its bisection in long double";

struct UnevenStroke {
  std::vector<double> t, x, f;
};

// `samples` samples, on average `step_m` apart, with a variation of a fifth.
UnevenStroke uneven_stroke(std::size_t samples, double step_m, double force = 1) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> uneven(0.8, 1.2);
  UnevenStroke made;
  double x = 0;
  for (std::size_t i = 0; i < samples; ++i, x += step_m * uneven(random)) {
    made.t.push_back(static_cast<double>(i));
    made.x.push_back(x);
    made.f.push_back(force * std::sin(0.3 * static_cast<double>(i)));
  }
  return made;
}

// Error of the force, re the largest, at some places of the grid.
double resample_error(const UnevenStroke& s, double pitch_m) {
  const double first = std::ceil(s.x.front() / pitch_m), last = std::floor(s.x.back() / pitch_m);
  const spatial::EvenPlaces places{first, pitch_m, static_cast<std::size_t>(last - first) + 1};
  std::vector<double> out(places.count);
  spatial::HermiteResampler resampler;
  resampler(s.t, s.x, s.f, 0, places, out);
  const spatial::reference::ExactHermite x(s.t, s.x), f(s.t, s.f);
  double error = 0;
  const std::size_t stride = std::max<std::size_t>(1, places.count / 300);
  for (std::size_t k = 0; k < places.count; k += stride)
    error = std::max(error, std::abs(out[k] - static_cast<double>(f.value(x.inverse(places.at(k))))));
  return error / largest_of(s.f);
}

// The cubic through two knots is a straight line.
double two_samples_error() {
  std::vector<double> out(101);
  spatial::HermiteResampler resampler;
  resampler(std::vector<double>{0, 1}, std::vector<double>{0, 1e-4}, std::vector<double>{2, 5}, 0,
            {0, 1e-6, 101}, out);
  double error = 0;
  for (std::size_t k = 0; k <= 100; ++k)
    error = std::max(error, std::abs(out[k] - (2 + 0.03 * static_cast<double>(k))));
  return error;
}

// A known surface under a known motion of any length.
double place_m(double sample) {
  return 5e-6 * (sample + 40 * std::sin(sample / 400));
}
double force_at(double x_m) {
  return std::sin(2 * kSpacePi * x_m / 0.8e-3);
}

// Resamples samples [begin, end) of the stroke and returns the largest error against the surface.
double window_error(spatial::HermiteResampler& resampler, std::size_t begin, std::size_t end, UnevenStroke& s,
                    std::vector<double>& out) {
  s.t.clear(), s.x.clear(), s.f.clear();
  for (std::size_t i = begin; i < end; ++i) {
    s.t.push_back(static_cast<double>(i - begin));
    s.x.push_back(place_m(static_cast<double>(i)));
    s.f.push_back(force_at(s.x.back()));
  }
  const double first = std::ceil(s.x[2] / 1e-6), last = std::floor(s.x[s.x.size() - 3] / 1e-6);
  const spatial::EvenPlaces places{first, 1e-6, static_cast<std::size_t>(last - first) + 1};
  out.resize(places.count);
  resampler(s.t, s.x, s.f, 0, places, out);
  double error = 0;
  for (std::size_t k = 0; k < places.count; k += 17)
    error = std::max(error, std::abs(out[k] - force_at(places.at(k))));
  return error;
}

// In windows, because the whole stroke would not fit into memory; the kernel uses only two knots to each
// side. The error is the monotone cubic's at 160 samples per period, the same from first to last.
Extreme long_stroke(std::size_t samples) {
  constexpr std::size_t kWindow = 100000;
  spatial::HermiteResampler resampler;
  UnevenStroke s;
  std::vector<double> out;
  const double first = window_error(resampler, 0, kWindow, s, out);
  double worst = 0;
  for (std::size_t begin = 0; begin < samples; begin += kWindow)
    worst = std::max(worst, window_error(resampler, begin, begin + kWindow, s, out));
  return {"spatial",
          samples >= 100000000 ? "a stroke of 1e8 samples" : "a stroke of 3e6 samples",
          "the surface itself; no worse than 1.5 times the first 1e5 samples",
          worst,
          1.5 * first,
          {}};
}

Extreme resampled(std::string condition, const UnevenStroke& s, double pitch_m, double most = 1e-11) {
  return {"spatial", std::move(condition), kExactCubic, resample_error(s, pitch_m), most, {}};
}

}  // namespace

std::vector<Extreme> space_extremes(bool all) {
  UnevenStroke far = uneven_stroke(4000, 5e-6);
  for (double& x : far.x) x += 1000;
  std::vector<Extreme> rows{
      resampled("resampled on 10 nm", uneven_stroke(4000, 5e-6), 1e-8),
      resampled("resampled on 1 mm", uneven_stroke(100000, 5e-6), 1e-3),
      resampled("one sample a millimetre, on 1 um", uneven_stroke(300, 1e-3), 1e-6),
      resampled("a million samples a millimetre, on 1 um", uneven_stroke(1000000, 1e-9), 1e-6),
      // A unit in the last place of 1 km is 1e-13 m, 2e-8 of a sample.
      resampled("a kilometre away, on 1 um", far, 1e-6, 2e-8),
      {"spatial", "a stroke of 2 samples", "a straight line", two_samples_error(), 1e-14, {}}};
  for (const auto& [scale, name] :
       {std::pair{1e30, "1e30 N"}, {1e-30, "1e-30 N"}, {1e-300, "1e-300 N"}, {1e-310, "1e-310 N, denormals"}})
    rows.push_back(
        resampled(std::string("resampled, forces of ") + name, uneven_stroke(4000, 5e-6, scale), 1e-6));
  rows.push_back(long_stroke(all ? 100000000 : 3000000));
  return rows;
}

}  // namespace tacto::analysis
