// SPDX-License-Identifier: GPL-3.0-or-later
// From a recording to complex cells of its spectrograms, against the same chain in extended precision:
// band-pass by its sum, positions inverted by bisection, monotone cubic, transform by its definition.
// Required for the whole chain: |X - X_exact| / max |X_exact| over all cells at most -100 dB.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <iostream>
#include <map>

#include "spatial/dsp/filter/block_fourier_filter.hpp"
#include "spatial/dsp/spectrum/short_time_transform.hpp"
#include "spatial/dsp/spectrum/window.hpp"
#include "spatial/reference/exact_hermite.hpp"
#include "spatial/reference/exact_short_time.hpp"
#include "spatial/reference/exact_treated_band_pass.hpp"
#include "spatial/spectrogram/spectrogram_options.hpp"
#include "spatial/texture/make_texture.hpp"
#include "tests/bench/workload.hpp"
#include "tests/measured.hpp"
#include "tests/spatial/force_and_position.hpp"

namespace tacto::spatial {
namespace {

// The benchmarks' recording, as a source.
class WorkloadSource : public samples::ForceAndPosition {
 public:
  explicit WorkloadSource(bench::Workload made) : made_(std::move(made)) {}
  schema::Result<void> read_stored(Track track, std::size_t first, std::span<double> out) override {
    const auto& values = track == Track::position ? made_.position_m : made_.force_n;
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), out.size(), out.begin());
    return {};
  }

 private:
  bench::Workload made_;
};

constexpr std::size_t kSeconds = 4;

TextureMaker maker_of(const bench::Workload& made) {
  schema::RecordingHeader header;
  header.frames = made.force_n.size();
  header.sample_rate_hz = bench::kRate_hz;
  auto record = TouchRecord::open(std::make_unique<WorkloadSource>(made), header, "workload");
  auto maker = TextureMaker::open(std::move(*record), {});
  return std::move(*maker);
}

// The band-pass in extended precision; each sample is computed when it is first used.
class ExactForce {
 public:
  explicit ExactForce(const bench::Workload& made)
      : exact_(made.force_n, bench::kRate_hz, kBand, kBand.low_hz,
               BlockFourierFilter(bench::kRate_hz, kBand).reach_s()) {}
  double operator()(std::size_t frame) {
    const auto [at, fresh] = known_.try_emplace(frame, 0.0);
    if (fresh) at->second = exact_(frame);
    return at->second;
  }

 private:
  static constexpr Band kBand{15, 500};
  reference::ExactTreatedBandPass exact_;
  std::map<std::size_t, double> known_;
};

// The exact texture of one stroke, a section of grid points at a time.
class ExactTexture {
 public:
  ExactTexture(const TextureMaker& maker, const Stroke& stroke, ExactForce& force)
      : stroke_(stroke),
        path_(monotone_path(*maker.record().position_m(stroke.frames), stroke.direction,
                            maker.record().position_error())),
        time_(path_.sample, path_.way_m),
        force_(force) {}

  // `count` values from point `first` of the bench's grid on.
  std::vector<double> values(double first, std::size_t count) {
    std::vector<long double> frames;
    for (std::size_t i = 0; i < count; ++i)
      frames.push_back(time_.inverse(stroke_.direction * (first + static_cast<double>(i)) * bench::kPitch_m));
    const auto [low, high] = std::minmax(frames.front(), frames.back());
    const auto force = around(static_cast<double>(low), static_cast<double>(high));
    std::vector<double> result;
    for (const long double frame : frames) result.push_back(static_cast<double>(force.value(frame)));
    return result;
  }

 private:
  // A slope of the monotone cubic depends on one sample beyond the next: three to each side are sufficient.
  reference::ExactHermite around(double low, double high) {
    std::vector<double> frames, forces;
    for (double frame = std::floor(low) - 3; frame <= std::ceil(high) + 3; ++frame) {
      frames.push_back(frame);
      forces.push_back(force_(stroke_.frames.begin + static_cast<std::size_t>(frame)));
    }
    return {frames, forces};
  }

  Stroke stroke_;
  MonotonePath path_;
  reference::ExactHermite time_;
  ExactForce& force_;
};

using Row = std::vector<std::complex<double>>;

// The given rows of a texture, as the spectrogram's transform computes them.
std::map<std::size_t, Row> rows_of(const schema::Texture& texture, const FrameShape& shape,
                                   const std::vector<std::size_t>& named) {
  ShortTimeTransform transform(shape, decimation_for(shape), blackman(shape.window), 1, true, 18000);
  std::vector<std::complex<float>> a(shape.bins), b(shape.bins);
  std::map<std::size_t, Row> rows;
  const auto keep = [&](std::size_t row, const std::vector<std::complex<float>>& cells, int exponent) {
    if (std::ranges::find(named, row) == named.end()) return;
    for (const auto cell : cells)
      rows[row].emplace_back(std::ldexp(cell.real(), exponent), std::ldexp(cell.imag(), exponent));
  };
  const auto done =
      transform.transform(texture.signal.values, [&](const PackedRows& packed) -> schema::Result<void> {
        packed.spectra(a, b);
        keep(packed.row, a, packed.exponent);
        if (packed.two) keep(packed.row + 1, b, packed.exponent);
        return {};
      });
  EXPECT_TRUE(done);
  return rows;
}

// Rows at both ends of one stroke in each direction.
double worst_db(double max_frequency_per_m) {
  static const bench::Workload made = bench::workload(kSeconds);
  static ExactForce force(made);  // slow to compute, so the next test reuses it
  TextureMaker maker = maker_of(made);
  SpectrogramOptions options;
  options.max_frequency_per_m = max_frequency_per_m;
  const FrameShape shape = *frame_shape(options, bench::kPitch_m);
  double largest = 0, largest_exact = 0;
  for (const std::size_t number : {std::size_t{0}, std::size_t{3}}) {
    const Stroke stroke = maker.record().strokes().at(number);
    const auto texture = maker.make(stroke, static_cast<int>(number) + 1);
    EXPECT_TRUE(texture);
    ExactTexture exact(maker, stroke, force);
    const std::size_t last = (texture->signal.values.size() - shape.window) / shape.hop;
    for (const auto& [row, cells] : rows_of(*texture, shape, {1, last - 1})) {
      const double first = std::round(texture->source_origin_m / bench::kPitch_m);
      const auto values = exact.values(first + static_cast<double>(row * shape.hop), shape.window);
      const auto target = reference::exact_short_time_row(values, shape, 0, true);
      for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::complex<long double> got(cells[k].real(), cells[k].imag());
        largest = std::max(largest, static_cast<double>(std::abs(got - target[k])));
        largest_exact = std::max(largest_exact, static_cast<double>(std::abs(target[k])));
      }
    }
  }
  EXPECT_GT(largest_exact, 1);  // a line of 0.05 N under a window of 10,000 samples
  return 20 * std::log10(largest / largest_exact);
}

TEST(WholeWay, IsExactTo100DbUpTo15PerMm) {
  const double db = worst_db(15e3);
  measured("spatial_whole_way.up_to_15_per_mm_db", db);
  EXPECT_LT(db, -100);
}

TEST(WholeWay, IsExactTo100DbAtAllBins) {
  const double db = worst_db(500e3);
  measured("spatial_whole_way.all_bins_db", db);
  EXPECT_LT(db, -100);
}

}  // namespace
}  // namespace tacto::spatial
