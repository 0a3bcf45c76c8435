// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/offline/offline_half.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include "analysis/trade/offline/spectrogram_errors.hpp"
#include "analysis/trade/rows/cpu_cost.hpp"
#include "analysis/trade/rows/stroked_texture.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/choose/budget_words.hpp"
#include "playback/model/texture_lookup.hpp"
#include "spatial/dsp/spectrum/window.hpp"
#include "spatial/reference/exact_short_time.hpp"
#include "spatial/spectrogram/budget.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorPoint;
using schema::length_for_people;
using schema::MeasuredChoice;
using schema::Result;
using schema::Spectrogram;
using schema::Texture;
using spatial::ResampleMethod;
using spatial::SpectrogramOptions;

constexpr double kPairedWindows_m[] = {2.5e-3, 5e-3, 10e-3};
constexpr double kPairedHops_m[] = {100e-6, 200e-6, 500e-6, 1e-3};
constexpr double kPairedPaddings[] = {1, 2, 4, 8};
constexpr double kFinestPadding = 16;

/// All pairs with one window.
class WindowPairs {
 public:
  WindowPairs(const Texture& texture, const OctaveEnergy& energy, double window_m)
      : texture_(texture), energy_(energy), options_(standard_spectrogram(texture)) {
    options_.window_m = window_m;
  }

  Result<void> add_hops(std::vector<TradeRow>& rows) const {
    const auto every = spatial::spatial_spectrogram(texture_, with_every_row(options_, texture_));
    TACTO_TRY(every);
    for (const double hop_m : kPairedHops_m) {
      SpectrogramOptions options = options_;
      options.hop_m = hop_m;
      const auto made = spatial::spatial_spectrogram(texture_, options);
      TACTO_TRY(made);
      rows.push_back(row(options, "hop", length_for_people(hop_m), *made, error_between_rows(*made, *every)));
    }
    return {};
  }

  Result<void> add_paddings(std::vector<TradeRow>& rows) const {
    const auto finest = spatial::spatial_spectrogram(texture_, padded(kFinestPadding));
    TACTO_TRY(finest);
    for (const double times : kPairedPaddings) {
      const auto made = spatial::spatial_spectrogram(texture_, padded(times));
      TACTO_TRY(made);
      rows.push_back(row(padded(times), "padding", fmt::format("{:g} windows", times), *made,
                         error_of_peaks(*made, *finest)));
    }
    return {};
  }

 private:
  SpectrogramOptions padded(double times) const {
    SpectrogramOptions options = options_;
    options.padded_m = times * options.window_m;
    return options;
  }

  TradeRow row(const SpectrogramOptions& options, const std::string& other, const std::string& choice,
               const Spectrogram& made, double other_error) const {
    const double window_error = energy_.error(made);
    TradeRow row = spectrogram_row(texture_, options, "window x " + other,
                                   length_for_people(options.window_m) + ", " + choice, made,
                                   std::hypot(window_error, other_error));
    row.note = fmt::format("the window {}, the {} {}", playback::percent(window_error), other,
                           playback::percent(other_error));
    return row;
  }

  const Texture& texture_;
  const OctaveEnergy& energy_;
  SpectrogramOptions options_;
};

double from_exact(const Texture& texture, const SpectrogramOptions& options, const Spectrogram& made) {
  const auto shape = spatial::frame_shape(options, texture.signal.pitch_m);
  const double sum_w = made.coherent_gain * static_cast<double>(shape->window);
  const std::size_t row = made.position_m.size() / 2;
  const auto exact = spatial::reference::exact_short_time_row(texture.signal.values, *shape, row, true);
  double off = 0, largest = 0;
  for (std::size_t k = 1; k < made.bins && k + 1 < exact.size(); ++k) {
    const double amplitude = 2 * static_cast<double>(std::abs(exact[k])) / sum_w;
    off = std::max(off, std::abs(static_cast<double>(made.at(row, k)) - amplitude));
    largest = std::max(largest, amplitude);
  }
  return off / largest;
}

Result<TradeRow> with_resolution(const Texture& texture, spatial::Resolution resolution, const char* name) {
  SpectrogramOptions options = standard_spectrogram(texture);
  options.scaling = schema::Scaling::amplitude;
  options.resolution = resolution;
  const auto made = spatial::spatial_spectrogram(texture, options);
  TACTO_TRY(made);
  return spectrogram_row(texture, options, "resolution", name, *made, from_exact(texture, options, *made));
}

Result<TradeRow> with_hop(const Texture& texture, double hop_m, const Spectrogram& every) {
  SpectrogramOptions options = standard_spectrogram(texture);
  options.hop_m = hop_m;
  const auto made = spatial::spatial_spectrogram(texture, options);
  TACTO_TRY(made);
  return spectrogram_row(texture, options, "hop", length_for_people(hop_m), *made,
                         error_between_rows(*made, every));
}

Result<Spectrogram> padded(const Texture& texture, double times, SpectrogramOptions& options) {
  options = standard_spectrogram(texture);
  options.padded_m = times * options.window_m;
  return spatial::spatial_spectrogram(texture, options);
}

Result<std::vector<TradeRow>> paddings(const Texture& texture) {
  SpectrogramOptions options;
  const auto finest = padded(texture, 16, options);
  TACTO_TRY(finest);
  std::vector<TradeRow> rows;
  for (const double times : {1.0, 2.0, 4.0, 8.0}) {
    const auto made = padded(texture, times, options);
    TACTO_TRY(made);
    rows.push_back(spectrogram_row(texture, options, "padding", fmt::format("{:g} windows", times), *made,
                                   error_of_peaks(*made, *finest)));
    rows.back().note = "height of the highest peak";
  }
  return rows;
}

Result<TradeRow> with_window(const Texture& texture, double window_m, const OctaveEnergy& energy) {
  SpectrogramOptions options = standard_spectrogram(texture);
  options.window_m = window_m;
  const auto made = spatial::spatial_spectrogram(texture, options);
  TACTO_TRY(made);
  TradeRow row =
      spectrogram_row(texture, options, "window", length_for_people(window_m), *made, energy.error(*made));
  row.note = "energy by octaves; separates lines from " +
             schema::for_people(3 / window_m, schema::Dimension::spatial_frequency);
  return row;
}

constexpr double kSinePoints[] = {2.2, 2.5, 3,  3.5, 4,  5,  6,  7,  8,   10,  12, 14,
                                  16,  20,  25, 32,  40, 50, 64, 80, 100, 200, 400};
constexpr double kWanders[] = {0, 0.1, 0.5};  // amplitude of the speed's variation, re its mean
constexpr std::size_t kStrokeFrames = 4000;
constexpr double kFrameWay_m = 5e-6;  // mean distance per frame
constexpr double kFineGrid_m = 1e-6;
constexpr std::size_t kLeftOut = 1000;  // samples at both ends

// Periods of the speed's variation, in frames; not commensurate with other periods. The shortest is the one
// for which the promise holds: spatial::kSteadyFrames.
constexpr double kWanderPeriods[] = {spatial::kSteadyFrames - 0.3, 937};

struct Stroke {
  spatial::MonotonePath path;
  std::vector<double> force;
};

Stroke stroke_over(double wavelength_m, double wander, double wander_period) {
  Stroke stroke;
  const double turn = 2 * std::numbers::pi / wander_period;
  for (std::size_t i = 0; i < kStrokeFrames; ++i) {
    const auto t = static_cast<double>(i);
    stroke.path.sample.push_back(t);
    stroke.path.way_m.push_back(kFrameWay_m * (t + wander * std::sin(turn * t) / turn));
    stroke.force.push_back(std::sin(2 * std::numbers::pi * stroke.path.way_m.back() / wavelength_m));
  }
  return stroke;
}

// RMS error re the RMS of the sine, whose highest local frequency has `points` frames per period.
double resampling_error(ResampleMethod method, double points, double wander, double wander_period) {
  const double wavelength_m = points * kFrameWay_m * (1 + wander);
  const Stroke stroke = stroke_over(wavelength_m, wander, wander_period);
  const auto grid = spatial::grid_along(stroke.path, 1, kFineGrid_m);
  const auto values = spatial::resample(stroke.path, 1, *grid, stroke.force, 0, method);
  double sum = 0;
  for (std::size_t k = kLeftOut; k + kLeftOut < values.size(); ++k) {
    const double exact = std::sin(2 * std::numbers::pi * grid->position_m(k) / wavelength_m);
    sum += std::pow(values[k] - exact, 2);
  }
  return std::sqrt(2 * sum / static_cast<double>(values.size() - 2 * kLeftOut));
}

double worst_resampling_error(ResampleMethod method, double points) {
  double worst = 0;
  for (const double period : kWanderPeriods)
    for (const double wander : kWanders)
      worst = std::max(worst, resampling_error(method, points, wander, period));
  return std::min(worst, 1.0);
}

constexpr ResampleMethod kAllMethods[] = {ResampleMethod::hermite, ResampleMethod::sinc};

// Cost of each method; the methods alternate.
std::vector<double> resampling_costs_ns() {
  constexpr int kTurns = 31;
  const Stroke stroke = stroke_over(100e-6, 0.1, kWanderPeriods[1]);
  const auto grid = spatial::grid_along(stroke.path, 1, kFineGrid_m);
  std::vector<double> out(grid->count);
  std::vector<std::function<void()>> works;
  for (const ResampleMethod method : kAllMethods)
    works.emplace_back([&, resampler = std::make_shared<spatial::Resampler>(method)] {
      (*resampler)(stroke.path, 1, *grid, stroke.force, 0, out);
    });
  return median_costs_ns(works, static_cast<double>(grid->count), kTurns);
}

// If rounding or a favourable phase makes an error smaller than that of a finer point, raises it: an upper
// bound must not increase with the number of points.
void make_falling(std::vector<ErrorPoint>& errors) {
  for (std::size_t i = errors.size(); i-- > 1;)
    errors[i - 1].error = std::max(errors[i - 1].error, errors[i].error);
}

double reading_error(double points) {
  constexpr std::size_t kSamples = 3000;
  schema::SpaceSignal signal{kFineGrid_m, 0, std::vector<double>(kSamples)};
  const auto exact = [&](double place) { return std::sin(2 * std::numbers::pi * place / points + 1); };
  for (std::size_t i = 0; i < kSamples; ++i) signal.values[i] = exact(static_cast<double>(i));
  const playback::TextureLookup lookup(signal, 0);
  double sum = 0;
  std::size_t read = 0;
  constexpr double kGolden = 0.618033988749895;  // reaches every part of a cell and of a period
  for (double place = kSamples / 3.0; place < kSamples * 2 / 3.0; place += kGolden, ++read)
    sum += std::pow(lookup(place * kFineGrid_m) - exact(place), 2);
  return std::min(1.0, std::sqrt(2 * sum / static_cast<double>(read)));
}

schema::Texture rough_texture() {
  schema::Texture texture;
  texture.signal.pitch_m = kFineGrid_m;
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  double level = 0;
  for (std::size_t i = 0; i < 12000; ++i) {
    level += 0.05 * (normal(random) - level);  // decreases with frequency, as in textures
    texture.signal.values.push_back(level);
  }
  return texture;
}

spatial::SpectrogramOptions spectrogram_options(spatial::Resolution resolution) {
  spatial::SpectrogramOptions options;
  options.window_m = 8e-3;
  options.scaling = schema::Scaling::amplitude;
  options.resolution = resolution;
  return options;
}

// Amplitudes against the exact ones of three rows: 2 |X| / sum w.
double spectrogram_error(const schema::Texture& texture, const spatial::SpectrogramOptions& options,
                         const schema::Spectrogram& made) {
  const auto shape = spatial::frame_shape(options, texture.signal.pitch_m);
  const double sum_w = made.coherent_gain * static_cast<double>(shape->window);
  double off = 0, largest = 0;
  for (const std::size_t row : {std::size_t{0}, made.position_m.size() / 2, made.position_m.size() - 1}) {
    const auto exact = spatial::reference::exact_short_time_row(texture.signal.values, *shape, row, true);
    for (std::size_t k = 1; k < made.bins; ++k) {
      const double amplitude = 2 * static_cast<double>(std::abs(exact[k])) / sum_w;
      off = std::max(off, std::abs(static_cast<double>(made.cells[row * made.bins + k]) - amplitude));
      largest = std::max(largest, amplitude);
    }
  }
  return off / largest;
}

MeasuredChoice spectrogram_choice(const char* name, spatial::Resolution resolution) {
  const schema::Texture texture = rough_texture();
  const auto options = spectrogram_options(resolution);
  const auto made = spatial::spatial_spectrogram(texture, options);
  const double cost_ns =
      median_cost_ns([&] { static_cast<void>(spatial::spatial_spectrogram(texture, options)); },
                     static_cast<double>(made->cells.size()));
  return {spatial::kSpectrogramStage,
          name,
          "cell",
          cost_ns,
          4,
          {{2, spectrogram_error(texture, options, *made)}}};
}

constexpr double kEnds_m = 1e-3;

// Error of the texture as playback interpolates it, made by one method on one grid, against the exact values.
double error_read(const StrokedTexture& stroked, const spatial::SpaceGrid& grid, std::vector<double> values) {
  const schema::SpaceSignal made{grid.pitch_m, 0, std::move(values)};
  const playback::TextureLookup lookup(made, grid.origin_m());
  std::vector<double> read, truth;
  constexpr double kReadingStep_m = 0.618e-6;
  for (double x = grid.origin_m() + kEnds_m + lookup.fade_m(); x < stroked.path.way_m.back() - 2 * kEnds_m;
       x += kReadingStep_m) {
    read.push_back(lookup(x));
    truth.push_back(stroked.value(x));
  }
  return relative_error(read, truth, 0);
}

TradeRow resampled(const StrokedTexture& stroked, ResampleMethod method, double pitch_m) {
  const auto grid = spatial::grid_along(stroked.path, 1, pitch_m);
  spatial::Resampler resampler(method);
  std::vector<double> values(grid->count);
  const auto work = [&] { resampler(stroked.path, 1, *grid, stroked.force, 0, values); };
  const double cost_ns = median_cost_ns(work, static_cast<double>(stroked.force.size()));
  return {"interpolation and grid",
          fmt::format("{}, {}", name_of(method), length_for_people(pitch_m)),
          error_read(stroked, *grid, values),
          cost_ns,
          "frame",
          4 * static_cast<double>(grid->count),
          0,
          {}};
}

// Error of a filter in the band, in the presence of components outside of the band.
Result<TradeRow> filtered(const StrokedTexture& stroked, const spatial::TimeFilter& filter,
                          const std::string& name) {
  std::vector<double> dirty = stroked.force;
  double power = 0;
  for (const double force : dirty) power += force * force;
  const double amplitude = std::sqrt(power / static_cast<double>(dirty.size()) / 2);
  constexpr double kDrift_hz = 2, kHum_hz = 1700;
  for (std::size_t i = 0; i < dirty.size(); ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / StrokedTexture::kRate_hz;
    dirty[i] += amplitude * (std::cos(kDrift_hz * turn) + std::sin(kHum_hz * turn));
  }
  auto kept = spatial::filter_in_time(dirty, StrokedTexture::kRate_hz, filter);
  TACTO_TRY(kept);
  const auto work = [&] {
    static_cast<void>(spatial::filter_in_time(dirty, StrokedTexture::kRate_hz, filter));
  };
  const auto frames = static_cast<double>(dirty.size());
  return TradeRow{"filter",
                  name,
                  relative_error(*kept, stroked.force, dirty.size() / 20),
                  median_cost_ns(work, frames),
                  "frame",
                  8 * frames,
                  0,
                  {}};
}

Result<std::vector<TradeRow>> filters(const StrokedTexture& stroked) {
  using spatial::Edges;
  using spatial::FilterMethod;
  struct Named {
    FilterMethod method;
    Edges edges;
    int order;
    const char* name;
  };
  std::vector<TradeRow> rows;
  for (const Named& each : {Named{FilterMethod::fourier, Edges::treated, 4, "fourier, edges treated"},
                            {FilterMethod::fourier, Edges::none, 4, "fourier, edges as they are"},
                            {FilterMethod::butterworth, Edges::treated, 2, "butterworth, order 2"},
                            {FilterMethod::butterworth, Edges::treated, 4, "butterworth, order 4"},
                            {FilterMethod::butterworth, Edges::treated, 8, "butterworth, order 8"}}) {
    spatial::TimeFilter filter;
    filter.method = each.method;
    filter.edges = each.edges;
    filter.order = each.order;
    filter.band = {StrokedTexture::kLow_hz, StrokedTexture::kHigh_hz};
    auto row = filtered(stroked, filter, each.name);
    TACTO_TRY(row);
    rows.push_back(std::move(*row));
  }
  return rows;
}

// The file's single precision against double precision.
TradeRow stored_single(const StrokedTexture& stroked) {
  const std::vector<double>& values = stroked.banded.signal.values;
  std::vector<double> rounded;
  for (const double value : values) rounded.push_back(static_cast<double>(static_cast<float>(value)));
  return {"stored",
          "single precision",
          relative_error(rounded, values, 0),
          0,
          "sample",
          4 * static_cast<double>(values.size()),
          0,
          "as texture files are"};
}

// Each choice of a spectrogram: varies resolution, hop, padding and window, one at a time, from the standard
// ones; references: see measure_offline. Cost in ns per sample of the texture. Errors: those of
// spatial_spectrogram.
Result<std::vector<TradeRow>> measure_spectrogram_trade(const Texture& texture) {
  std::vector<TradeRow> rows;
  std::optional<schema::Error> failed;
  const auto take = [&](Result<TradeRow> row) {
    if (row)
      rows.push_back(std::move(*row));
    else if (!failed)
      failed = row.error();
  };
  take(with_resolution(texture, spatial::Resolution::automatic, "auto"));
  take(with_resolution(texture, spatial::Resolution::whole, "whole"));
  const auto every =
      spatial::spatial_spectrogram(texture, with_every_row(standard_spectrogram(texture), texture));
  TACTO_TRY(every);
  for (const double hop_m : {100e-6, 200e-6, 500e-6, 1e-3}) take(with_hop(texture, hop_m, *every));
  const auto energy = OctaveEnergy::of(texture);
  TACTO_TRY(energy);
  for (const double window_m : {1.25e-3, 2.5e-3, 5e-3, 10e-3}) take(with_window(texture, window_m, *energy));
  for (auto more : {paddings(texture), measure_spectrogram_pairs(texture, *energy)}) {
    TACTO_TRY(more);
    std::ranges::move(*more, std::back_inserter(rows));
  }
  if (failed) return tl::unexpected(*failed);
  return rows;
}

}  // namespace

Result<std::vector<TradeRow>> measure_spectrogram_pairs(const Texture& texture, const OctaveEnergy& energy) {
  std::vector<TradeRow> rows;
  for (const double window_m : kPairedWindows_m)
    TACTO_TRY(WindowPairs(texture, energy, window_m).add_hops(rows));
  for (const double window_m : kPairedWindows_m)
    TACTO_TRY(WindowPairs(texture, energy, window_m).add_paddings(rows));
  return rows;
}

std::vector<MeasuredChoice> measure_resampling() {
  const auto costs_ns = resampling_costs_ns();
  std::vector<MeasuredChoice> choices;
  for (const ResampleMethod method : kAllMethods) {
    MeasuredChoice choice{
        spatial::kResamplingStage, std::string(name_of(method)), "sample", costs_ns[choices.size()], 0, {}};
    for (const double points : kSinePoints)
      choice.errors.push_back({points, worst_resampling_error(method, points)});
    make_falling(choice.errors);
    choices.push_back(std::move(choice));
  }
  return choices;
}

MeasuredChoice measure_grid() {
  MeasuredChoice choice{spatial::kGridStage, "hermite", "sample", 0, 4, {}};
  for (const double points : kSinePoints) choice.errors.push_back({points, reading_error(points)});
  make_falling(choice.errors);
  return choice;
}

std::vector<MeasuredChoice> measure_spectrogram() {
  return {spectrogram_choice("auto", spatial::Resolution::automatic),
          spectrogram_choice("whole", spatial::Resolution::whole)};
}

Result<std::vector<TradeRow>> measure_offline(const schema::Texture& texture,
                                              const std::function<void(double)>& progress) {
  const auto stroked = StrokedTexture::of(texture);
  TACTO_TRY(stroked);
  std::vector<TradeRow> rows;
  constexpr ResampleMethod kMethods[] = {ResampleMethod::hermite, ResampleMethod::sinc};
  for (const ResampleMethod method : kMethods)
    for (const double pitch_m : spatial::kGrids_m) {
      rows.push_back(resampled(*stroked, method, pitch_m));
      if (progress)
        progress(0.6 * static_cast<double>(rows.size()) /
                 static_cast<double>(std::size(kMethods) * std::size(spatial::kGrids_m)));
    }
  auto more = filters(*stroked);
  TACTO_TRY(more);
  std::ranges::move(*more, std::back_inserter(rows));
  rows.push_back(stored_single(*stroked));
  if (progress) progress(0.75);
  more = measure_spectrogram_trade(stroked->banded);
  TACTO_TRY(more);
  std::ranges::move(*more, std::back_inserter(rows));
  return rows;
}

}  // namespace tacto::analysis
