// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/spectrogram_trade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "analysis/trade/cpu_cost.hpp"
#include "analysis/trade/stroked_texture.hpp"
#include "data-schema/quantity.hpp"
#include "spatial/reference/exact_short_time.hpp"
#include "spatial/space_filter.hpp"
#include "spatial/spectrogram.hpp"

namespace tacto::analysis {
namespace {

using schema::length_for_people;
using schema::Result;
using schema::Spectrogram;
using schema::Texture;
using spatial::SpectrogramOptions;

constexpr double kWindow_m = 5e-3;  // of a texture from 12 mm on there are some rows
constexpr double kFineHop_m = 25e-6;

SpectrogramOptions standard_options(const Texture& texture) {
  SpectrogramOptions options;
  options.window_m = kWindow_m;
  options.max_frequency_per_m = std::min(options.max_frequency_per_m, 0.45 / texture.signal.pitch_m);
  return options;
}

Result<TradeRow> row_for(const Texture& texture, const SpectrogramOptions& options, const char* knob,
                         const std::string& choice, const Spectrogram& made, double error) {
  const auto work = [&] { static_cast<void>(spatial::spatial_spectrogram(texture, options)); };
  return TradeRow{knob,     choice,
                  error,    median_cost_ns(work, static_cast<double>(texture.signal.values.size())),
                  "sample", 4 * static_cast<double>(made.cells.size()),
                  0,        {}};
}

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
  SpectrogramOptions options = standard_options(texture);
  options.scaling = schema::Scaling::amplitude;
  options.resolution = resolution;
  const auto made = spatial::spatial_spectrogram(texture, options);
  if (!made) return schema::forward_error(made);
  return row_for(texture, options, "resolution", name, *made, from_exact(texture, options, *made));
}

// The power of each row, straight between rows, against that of all rows.
double between_rows(const Spectrogram& made, const Spectrogram& every) {
  const auto power = [](const Spectrogram& of, std::size_t p) {
    const auto row = of.cells.begin() + static_cast<std::ptrdiff_t>(p * of.bins);
    return std::accumulate(row, row + static_cast<std::ptrdiff_t>(of.bins), 0.0);
  };
  double off = 0, all = 0;
  for (std::size_t p = 0; p < every.position_m.size(); ++p) {
    const double place = (every.position_m[p] - made.position_m.front()) / made.hop_m;
    const auto i = static_cast<std::size_t>(std::max(0.0, std::floor(place)));
    if (i + 1 >= made.position_m.size()) break;
    const double share = place - static_cast<double>(i);
    const double read = (1 - share) * power(made, i) + share * power(made, i + 1);
    off += std::pow(read - power(every, p), 2);
    all += std::pow(power(every, p), 2);
  }
  return std::sqrt(off / all);
}

Result<TradeRow> with_hop(const Texture& texture, double hop_m, const Spectrogram& every) {
  SpectrogramOptions options = standard_options(texture);
  options.hop_m = hop_m;
  const auto made = spatial::spatial_spectrogram(texture, options);
  if (!made) return schema::forward_error(made);
  return row_for(texture, options, "hop", length_for_people(hop_m), *made, between_rows(*made, every));
}

double mean_peak(const Spectrogram& made) {
  double sum = 0;
  for (std::size_t p = 0; p < made.position_m.size(); ++p) {
    const auto row = made.cells.begin() + static_cast<std::ptrdiff_t>(p * made.bins);
    sum += static_cast<double>(*std::max_element(row, row + static_cast<std::ptrdiff_t>(made.bins)));
  }
  return sum / static_cast<double>(made.position_m.size());
}

Result<Spectrogram> padded(const Texture& texture, double times, SpectrogramOptions& options) {
  options = standard_options(texture);
  options.scaling = schema::Scaling::amplitude;
  options.padded_m = times * options.window_m;
  return spatial::spatial_spectrogram(texture, options);
}

Result<std::vector<TradeRow>> paddings(const Texture& texture) {
  SpectrogramOptions options;
  const auto finest = padded(texture, 16, options);
  if (!finest) return schema::forward_error(finest);
  std::vector<TradeRow> rows;
  for (const double times : {1.0, 2.0, 4.0, 8.0}) {
    const auto made = padded(texture, times, options);
    if (!made) return schema::forward_error(made);
    auto row = row_for(texture, options, "padding", fmt::format("{:g} windows", times), *made,
                       std::abs(mean_peak(*made) / mean_peak(*finest) - 1));
    if (!row) return schema::forward_error(row);
    row->note = "height of the highest peak";
    rows.push_back(std::move(*row));
  }
  return rows;
}

constexpr double kOctaves_per_m[] = {500, 1000, 2000, 4000, 8000};

// The ends, which windows see less of than of the rest, are left out of both.
double left_out_m(const Texture& texture) {
  return std::min(5e-3, texture.signal.length_m() / 4);
}

// Energy an octave, per sample.
Result<std::vector<double>> octave_powers(const Texture& texture) {
  std::vector<double> powers;
  for (std::size_t i = 0; i + 1 < std::size(kOctaves_per_m); ++i) {
    spatial::SpaceFilter band;
    band.low_per_m = kOctaves_per_m[i];
    band.high_per_m = kOctaves_per_m[i + 1];
    const auto values = spatial::filter_in_space(texture.signal.values, texture.signal.pitch_m, band);
    if (!values) return schema::forward_error(values);
    const auto left_out = static_cast<std::size_t>(left_out_m(texture) / texture.signal.pitch_m);
    double power = 0;
    for (std::size_t k = left_out; k + left_out < values->size(); ++k) power += (*values)[k] * (*values)[k];
    powers.push_back(power / static_cast<double>(values->size() - 2 * left_out));
  }
  return powers;
}

std::vector<double> octave_powers(const Spectrogram& made, double from_m, double to_m) {
  std::vector<double> powers(std::size(kOctaves_per_m) - 1);
  std::size_t rows = 0;
  for (std::size_t p = 0; p < made.position_m.size(); ++p) {
    if (made.position_m[p] < from_m || made.position_m[p] > to_m) continue;
    ++rows;
    for (std::size_t k = 0; k < made.bins; ++k)
      for (std::size_t i = 0; i < powers.size(); ++i)
        if (made.frequency_per_m(k) >= kOctaves_per_m[i] && made.frequency_per_m(k) < kOctaves_per_m[i + 1])
          powers[i] += static_cast<double>(made.at(p, k)) * made.frequency_step_per_m;
  }
  for (double& power : powers) power /= static_cast<double>(rows);
  return powers;
}

Result<TradeRow> with_window(const Texture& texture, double window_m, const std::vector<double>& truth) {
  SpectrogramOptions options = standard_options(texture);
  options.window_m = window_m;
  const auto made = spatial::spatial_spectrogram(texture, options);
  if (!made) return schema::forward_error(made);
  const double from_m = left_out_m(texture), to_m = texture.signal.length_m() - from_m;
  const double error = relative_error(octave_powers(*made, from_m, to_m), truth, 0);
  auto row = row_for(texture, options, "window", length_for_people(window_m), *made, error);
  if (row)
    row->note = "energy by octaves; tells lines apart from " +
                schema::for_people(3 / window_m, schema::Dimension::spatial_frequency);
  return row;
}

}  // namespace

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
  SpectrogramOptions every_row = standard_options(texture);
  every_row.hop_m = std::max(kFineHop_m, texture.signal.pitch_m);
  const auto every = spatial::spatial_spectrogram(texture, every_row);
  if (!every) return schema::forward_error(every);
  for (const double hop_m : {100e-6, 200e-6, 500e-6, 1e-3}) take(with_hop(texture, hop_m, *every));
  const auto truth = octave_powers(texture);
  if (!truth) return schema::forward_error(truth);
  for (const double window_m : {1.25e-3, 2.5e-3, 5e-3, 10e-3}) take(with_window(texture, window_m, *truth));
  auto padded_rows = paddings(texture);
  if (!padded_rows) return schema::forward_error(padded_rows);
  std::ranges::move(*padded_rows, std::back_inserter(rows));
  if (failed) return tl::unexpected(*failed);
  return rows;
}

}  // namespace tacto::analysis
