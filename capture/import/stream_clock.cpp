// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/stream_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "capture/table/text_encoding.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

// The drift of a stream's clock against the recorder's, from clock offsets of which some may be wrong.

struct OffsetDrift {
  double drift_ppm = 0;                    ///< above zero: the stream's clock is fast
  double ahead_s = 0;                      ///< of the line at the first pair, less that pair's own
  double lowest_ppm = 0, highest_ppm = 0;  ///< the 95 % interval of the drift
  double deviation_s = 0;                  ///< the median of the distances from the line
  bool is_certain() const { return lowest_ppm > 0 || highest_ppm < 0; }
};

constexpr std::size_t kFewestOffsets = 4;
constexpr std::size_t kMostPoints = 1000;  // half a million slopes
constexpr double kShortestDrift_s = 10;
constexpr double kNormal95 = 1.959963984540054;  // the normal quantile of 97.5 %

struct OffsetPoint {
  double host_s, device_ahead_s;
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

// Relative to the first pair: the hours since the computer was started would cost precision.
std::vector<OffsetPoint> points_of(std::span<const schema::ClockPair> pairs) {
  const std::size_t block = (pairs.size() + kMostPoints - 1) / kMostPoints;
  std::vector<OffsetPoint> points;
  for (std::size_t first = 0; first < pairs.size(); first += block) {
    std::vector<double> host_s, ahead_s;
    for (const schema::ClockPair& pair : pairs.subspan(first, std::min(block, pairs.size() - first))) {
      host_s.push_back(pair.host_s - pairs[0].host_s);
      ahead_s.push_back(pair.device_s - pairs[0].device_s - host_s.back());
    }
    points.push_back({median_of(host_s), median_of(ahead_s)});
  }
  return points;
}

std::vector<double> sorted_slopes(const std::vector<OffsetPoint>& points) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = i + 1; k < points.size(); ++k)
      if (const double step_s = points[k].host_s - points[i].host_s; step_s > 0)
        slopes.push_back((points[k].device_ahead_s - points[i].device_ahead_s) / step_s);
  std::ranges::sort(slopes);
  return slopes;
}

std::vector<double> without_slope(const std::vector<OffsetPoint>& points, double slope) {
  std::vector<double> left;
  for (const OffsetPoint& point : points) left.push_back(point.device_ahead_s - slope * point.host_s);
  return left;
}

// Theil-Sen: the median of the slopes through all pairs of offsets, so that up to 29 % of them may be wrong
// by any amount; its interval is Sen's (J. Am. Stat. Assoc. 63, 1968, 1379-1389). More than 1,000 offsets
// are reduced to medians of consecutive ones. None for fewer than 4 offsets, whose interval has no end, or
// if they span less than 10 s. The interval assumes independent deviations. `pairs`: in the order of time.
std::optional<OffsetDrift> offset_drift(std::span<const schema::ClockPair> pairs) {
  if (pairs.size() < kFewestOffsets || pairs.back().host_s - pairs.front().host_s < kShortestDrift_s)
    return std::nullopt;
  const auto points = points_of(pairs);
  const auto slopes = sorted_slopes(points);
  const auto n = static_cast<double>(points.size()), count = static_cast<double>(slopes.size());
  const double half_width = kNormal95 * std::sqrt(n * (n - 1) * (2 * n + 5) / 18);
  const auto below = static_cast<std::ptrdiff_t>(std::floor((count - half_width) / 2));
  if (below < 0) return std::nullopt;
  const double slope = median_of(slopes);
  auto left = without_slope(points, slope);
  const double ahead_s = median_of(left);
  for (double& each : left) each = std::abs(each - ahead_s);
  return OffsetDrift{1e6 * slope, ahead_s, 1e6 * slopes[static_cast<std::size_t>(below)],
                     1e6 * slopes[slopes.size() - 1 - static_cast<std::size_t>(below)], median_of(left)};
}

// `fit` is offset_drift() of the pairs.
RecorderClock recorder_clock(std::span<const schema::ClockPair> pairs,
                             const std::optional<OffsetDrift>& fit) {
  if (pairs.empty()) return {};
  if (fit && fit->is_certain())
    return {pairs[0].device_s + fit->ahead_s, pairs[0].host_s, 1 / (1 + 1e-6 * fit->drift_ppm)};
  const double ahead_s = median_of(without_slope(points_of(pairs), 0));
  return {pairs[0].device_s + ahead_s, pairs[0].host_s, 1};
}

constexpr std::string_view kWithoutTimes = "--rate imports its samples as even, without their times";

tl::unexpected<schema::Error> was_reset(const std::string& where, double time_s, double jump_s) {
  return fail(ErrorKind::unsuitable,
              fmt::format("the stream's clock was reset at {:.6f} s (it jumped by {:.6g} s)", time_s, jump_s),
              where,
              "write the part before or after it to a MATLAB file with pyxdf and import that, or: " +
                  std::string(kWithoutTimes));
}

Result<std::vector<schema::ClockPair>> clock_pairs(const std::string& where,
                                                   const schema::XdfStream& stream) {
  std::vector<schema::ClockPair> pairs;
  for (const auto& [time_s, ahead_s] : stream.clock_offsets) {
    const schema::ClockPair pair{0, time_s, time_s + ahead_s};
    if (!pairs.empty()) {
      const double step_s = time_s - pairs.back().device_s;
      const double jump_s = step_s - (pair.host_s - pairs.back().host_s);
      if (step_s < 0 || std::abs(jump_s) > kClockReset_s)
        return was_reset(where, time_s, step_s < 0 ? step_s : jump_s);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

// Sums for a line through the times of the samples between two gaps, updated sample by sample (Welford), so
// that the hours since the computer was started cost no precision.
class Part {
 public:
  Part(std::uint64_t first_sample, double first_s) : first_sample_(first_sample), first_s_(first_s) {}
  void add(double time_s) {
    const double x = n_, y = time_s - first_s_;
    n_ += 1;
    const double dx = x - mean_x_, dy = y - mean_y_;
    mean_x_ += dx / n_;
    mean_y_ += dy / n_;
    xx_ += dx * (x - mean_x_);
    xy_ += dx * (y - mean_y_);
    yy_ += dy * (y - mean_y_);
  }
  double xx() const { return xx_; }
  double xy() const { return xy_; }
  double yy() const { return yy_; }
  std::uint64_t first_sample() const { return first_sample_; }
  // The times of the first and last sample on a line of this slope.
  double begin_s(double period_s) const { return first_s_ + mean_y_ - period_s * mean_x_; }
  double end_s(double period_s) const { return begin_s(period_s) + period_s * (n_ - 1); }

 private:
  std::uint64_t first_sample_;
  double first_s_, n_ = 0, mean_x_ = 0, mean_y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
};

struct ScatteredClock {
  UniformClock clock;
  double begin_s = 0;    // the line at the first sample
  double scatter_s = 0;  // RMS about the lines
};

// Times of a stream that has a nominal rate, whatever their scatter.
class ScatterFit {
 public:
  explicit ScatterFit(double nominal_rate_hz)
      : longest_step_s_(std::max(kLongestScatter_s, kLongestScatter_samples / nominal_rate_hz)) {}
  void add(double time_s) {
    if (parts_.empty() || time_s - last_s_ > longest_step_s_) parts_.emplace_back(samples_, time_s);
    parts_.back().add(time_s);
    last_s_ = time_s;
    ++samples_;
  }
  std::optional<ScatteredClock> clock() const;

 private:
  double longest_step_s_, last_s_ = 0;
  std::uint64_t samples_ = 0;
  std::vector<Part> parts_;
};

std::optional<ScatteredClock> ScatterFit::clock() const {
  double xx = 0, xy = 0, yy = 0;
  for (const Part& part : parts_) xx += part.xx(), xy += part.xy(), yy += part.yy();
  const double period_s = xy / xx;
  if (!(period_s > 0)) return std::nullopt;  // also NaN: parts of one sample
  ScatteredClock found{{1 / period_s, {}},
                       parts_.front().begin_s(period_s),
                       std::sqrt(std::max(0.0, yy - period_s * xy) / static_cast<double>(samples_))};
  std::uint64_t missing = 0;
  for (std::size_t k = 1; k < parts_.size(); ++k) {
    const double periods = (parts_[k].begin_s(period_s) - parts_[k - 1].end_s(period_s)) / period_s;
    if (!(periods <= kLongestGap_samples)) return std::nullopt;
    const auto count = static_cast<std::uint64_t>(std::max(0.0, std::round(periods) - 1));
    if (count == 0) continue;
    missing += count;
    const std::uint64_t sample = parts_[k].first_sample();
    found.clock.gaps.push_back({sample, sample + missing, count});
  }
  return found;
}

// The stream during reading.
class Search {
 public:
  Search(const std::string& file, const schema::XdfStream& stream,
         const std::function<void(double)>& progress)
      : file_(file),
        stream_(stream),
        progress_(progress),
        where_(fmt::format("{}: stream '{}'", file, stream.name)) {}
  Result<StreamClock> run() {
    const auto pairs = clock_pairs(where_, stream_);
    TACTO_TRY(pairs);
    TACTO_TRY(survey());
    auto located = even_.second_pass_needed() ? locate() : Result<void>{};
    const auto scattered = located || !scatter_ ? std::nullopt : scatter_->clock();
    if (located) {
      found_.clock = even_.clock();
      found_.begin_s = first_s_;
      if (even_.pauses() > 0)
        found_.warnings.push_back(fmt::format(
            "{} of its pauses are no whole number of periods: their gaps are to the nearest sample",
            even_.pauses()));
    } else if (scattered) {
      use_scattered(*scattered);
    } else {
      located.error().remedy = kWithoutTimes;
      return schema::forward_error(located);
    }
    move_to_recorders_clock(*pairs);
    compare_with_nominal();
    return std::move(found_);
  }

 private:
  Result<void> survey() {
    if (stream_.nominal_rate_hz > 0) scatter_.emplace(stream_.nominal_rate_hz);
    std::optional<double> last_s;
    const auto take = [&](std::span<const double> times_s, std::span<const double>) -> Result<void> {
      even_.survey(times_s);
      for (const double time_s : times_s) {
        if (last_s && time_s < *last_s - kClockReset_s) return was_reset(where_, *last_s, time_s - *last_s);
        if (last_s && (time_s - *last_s) * stream_.nominal_rate_hz > kLongestGap_samples)
          return was_reset(where_, *last_s, time_s - *last_s);
        if (scatter_) scatter_->add(time_s);
        if (!last_s) first_s_ = time_s;
        last_s = time_s;
      }
      return {};
    };
    TACTO_TRY(schema::read_xdf(file_, stream_, {}, take, progress_));
    return even_.end_survey(where_);
  }

  Result<void> locate() {
    even_.allow_pauses();
    const auto place_of = [](std::uint64_t row) { return fmt::format("sample {}", row); };
    return schema::read_xdf(
        file_, stream_, {},
        [&](std::span<const double> times_s, std::span<const double>) {
          return even_.locate(times_s, place_of, where_);
        },
        progress_);
  }

  void use_scattered(const ScatteredClock& scattered) {
    found_.clock = scattered.clock;
    found_.begin_s = scattered.begin_s;
    found_.warnings.push_back(fmt::format(
        "its times scatter by {:.3g} ms (RMS) about an even rate, so gaps shorter than {:g} s are not "
        "found",
        1e3 * scattered.scatter_s,
        std::max(kLongestScatter_s, kLongestScatter_samples / stream_.nominal_rate_hz)));
  }

  void compare_with_nominal() {
    constexpr double kFarFromNominal = 0.01;  // crystals deviate by less than 0.0001
    const double nominal_hz = stream_.nominal_rate_hz, rate_hz = found_.clock.rate_hz;
    if (nominal_hz > 0 && std::abs(rate_hz / nominal_hz - 1) > kFarFromNominal)
      found_.warnings.push_back(fmt::format(
          "its times give a rate of {:.6g} Hz, but its nominal rate is {:.6g} Hz", rate_hz, nominal_hz));
  }

  void move_to_recorders_clock(std::span<const schema::ClockPair> pairs) {
    constexpr double kFastForACrystal_ppm = 100;
    const auto fit = offset_drift(pairs);
    found_.begin_s = recorder_clock(pairs, fit).at(found_.begin_s);
    if (!fit || !fit->is_certain()) {
      found_.words = "times of the stream, by its own clock " +
                     (fit ? fmt::format("(its drift of {:.3g} ppm is not certain: {:.3g} to {:.3g} ppm)",
                                        fit->drift_ppm, fit->lowest_ppm, fit->highest_ppm)
                          : "(too few clock offsets, or too close in time)");
      return;
    }
    found_.clock.rate_hz *= 1 + 1e-6 * fit->drift_ppm;
    found_.words = fmt::format(
        "times of the stream, by the recorder's clock: that of the stream is {:.3g} ppm {} ({} clock "
        "offsets, median deviation {:.3g} ms)",
        std::abs(fit->drift_ppm), fit->drift_ppm < 0 ? "slower" : "faster", pairs.size(),
        1e3 * fit->deviation_s);
    if (std::abs(fit->drift_ppm) > kFastForACrystal_ppm)
      found_.warnings.push_back(fmt::format(
          "its clock is {:.3g} ppm {} than the recorder's: crystals deviate by less than {:g} ppm",
          std::abs(fit->drift_ppm), fit->drift_ppm < 0 ? "slower" : "faster", kFastForACrystal_ppm));
  }

  const std::string& file_;
  const schema::XdfStream& stream_;
  const std::function<void(double)>& progress_;
  std::string where_;
  double first_s_ = 0;  // the time of the first sample
  ClockFinder even_;
  std::optional<ScatterFit> scatter_;
  StreamClock found_;
};

}  // namespace

Result<StreamClock> find_stream_clock(const std::string& file, const schema::XdfStream& stream,
                                      const std::function<void(double)>& progress) {
  return Search(file, stream, progress).run();
}

Result<StreamMarks> find_stream_marks(const std::string& file, const schema::XdfContents& contents,
                                      const schema::XdfStream& samples, const StreamClock& clock) {
  StreamMarks found;
  const auto texts = std::ranges::count_if(contents.streams, &schema::XdfStream::is_text);
  for (const schema::XdfStream& stream : contents.streams) {
    if (!stream.is_text()) continue;
    const std::string where = fmt::format("stream '{}'", stream.name);
    const auto pairs = clock_pairs(where, stream);
    auto markers = schema::read_xdf_markers(file, stream);
    if (!markers && markers.error().kind != ErrorKind::unsuitable) return schema::forward_error(markers);
    if (!markers || !pairs) {
      const schema::Error& error = markers ? pairs.error() : markers.error();
      found.warnings.push_back(fmt::format("{} gives no marks: {}", where, error.what));
      continue;
    }
    if ((pairs->empty() || samples.clock_offsets.empty()) && !markers->empty())
      found.warnings.push_back(fmt::format(
          "{}: without clock offsets of it and of the samples, their times are taken as of one clock",
          where));
    const RecorderClock recorder = recorder_clock(*pairs, offset_drift(*pairs));
    for (const schema::XdfMarker& marker : *markers) {
      const double at_s = recorder.at(marker.time_s) - clock.begin_s;
      found.marks.push_back({std::isnan(at_s) ? INFINITY : at_s,
                             to_utf8(texts > 1 ? stream.name + ": " + marker.label : marker.label)});
    }
  }
  std::ranges::stable_sort(found.marks, {}, &StreamMark::at_s);
  return found;
}

}  // namespace tacto::capture
