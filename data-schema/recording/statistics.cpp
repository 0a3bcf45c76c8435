// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/wav/wav.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kBlockFrames = 16384;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void add_frames(std::vector<Statistics>& statistics, std::span<const Channel> channels,
                std::span<const double> frames) {
  for (std::size_t c = 0; c < channels.size(); ++c)
    for (std::size_t i = c; i < frames.size(); i += channels.size())
      statistics[c].add(channels[c].physical(frames[i]));
}

}  // namespace

void Statistics::add(double value) {
  if (!std::isfinite(value)) {
    if (not_finite_++ == 0) first_not_finite_ = count_;
  } else {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    sum_ += value;
    sum_of_squares_ += value * value;
  }
  ++count_;
}

double Statistics::per_number(double sum) const {
  return count_ == not_finite_ ? kNone : sum / static_cast<double>(count_ - not_finite_);
}
double Statistics::min() const {
  return count_ == not_finite_ ? kNone : min_;
}
double Statistics::max() const {
  return count_ == not_finite_ ? kNone : max_;
}
double Statistics::mean() const {
  return per_number(sum_);
}
double Statistics::rms() const {
  return std::sqrt(per_number(sum_of_squares_));
}

Statistics statistics_of(std::span<const double> values) {
  Statistics statistics;
  for (const double value : values) statistics.add(value);
  return statistics;
}

Result<std::vector<Statistics>> channel_statistics(const std::string& wav, std::span<const Channel> channels,
                                                   const std::function<void(double)>& progress) {
  auto reader = WavReader::open(wav);
  TACTO_TRY(reader);
  const WavInfo info = reader->info();
  if (info.channels != channels.size())
    return fail(ErrorKind::malformed,
                fmt::format("has {} channels, its sidecar {}", info.channels, channels.size()), wav);
  std::vector<Statistics> statistics(channels.size());
  std::vector<double> block(kBlockFrames * channels.size());
  for (std::uint64_t done = 0;;) {
    const auto frames = reader->read(block);
    TACTO_TRY(frames);
    if (*frames == 0) return statistics;
    add_frames(statistics, channels, std::span(block).first(*frames * channels.size()));
    done += *frames;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(info.frames));
  }
}

}  // namespace tacto::schema
