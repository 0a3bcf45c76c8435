// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/spectrogram_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "data-schema/base/quantity.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using schema::Result;

// A length in samples with its allowed range; `least` is the text for the lower limit in messages.
struct Asked {
  const char* what;
  const char* where;
  double length_m;
  std::size_t least;
  std::string least_name;
};

// NaN is in no range, so it is an error, too.
Result<std::size_t> samples_of(const Asked& asked, double pitch_m) {
  const double samples = asked.length_m / pitch_m;
  const auto least = static_cast<double>(asked.least), most = static_cast<double>(kLongestTransform);
  if (samples > least - 0.5 && samples < most + 0.5)
    return std::clamp(static_cast<std::size_t>(std::llround(samples)), asked.least, kLongestTransform);
  return schema::fail(
      ErrorKind::usage,
      fmt::format("{} of {} cannot be used", asked.what, schema::length_for_people(asked.length_m)),
      asked.where,
      fmt::format("use {} ({}) to {} (2^24 samples)", schema::length_for_people(least * pitch_m),
                  asked.least_name, schema::length_for_people(most * pitch_m)));
}

// Rounding does not exclude a bin at the limit.
std::size_t bins_to(double frequency_per_m, std::size_t padded, double pitch_m) {
  const double last = frequency_per_m * static_cast<double>(padded) * pitch_m * (1 + 1e-12);
  return 1 +
         static_cast<std::size_t>(std::min(std::floor(last), std::floor(static_cast<double>(padded) / 2)));
}

}  // namespace

Result<FrameShape> frame_shape(const SpectrogramOptions& options, double pitch_m) {
  FrameShape shape;
  const auto window =
      samples_of({"a window", "window", options.window_m, kShortestWindow, "8 samples"}, pitch_m);
  TACTO_TRY(window);
  shape.window = *window;
  const auto hop = samples_of({"a hop", "hop", options.hop_m, 1, "one sample"}, pitch_m);
  TACTO_TRY(hop);
  shape.hop = *hop;
  shape.padded = std::bit_ceil(shape.window);
  if (options.padded_m) {
    const auto padded =
        samples_of({"a padded length", "padding", *options.padded_m, shape.window, "the window"}, pitch_m);
    TACTO_TRY(padded);
    shape.padded = *padded;
  }
  if (!(options.max_frequency_per_m > 0))
    return schema::fail(ErrorKind::usage, "the maximum frequency must be above 0", "maximum frequency",
                        "15/mm is the default");
  shape.bins = bins_to(options.max_frequency_per_m, shape.padded, pitch_m);
  return shape;
}

}  // namespace tacto::spatial
