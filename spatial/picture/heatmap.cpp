// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/heatmap.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace tacto::spatial {
namespace {

using schema::Spectrogram;

constexpr int kColours = cv::COLORMAP_VIRIDIS;

// A pixel row at the top of the axis covers several bins: this many lines are taken in each, then averaged.
constexpr int kLinesPerRow = 4;

// cv::remap counts in 16 bits. More bins than this are averaged down first; a page has far fewer rows.
constexpr int kMostBins = 30000;

// OpenCV wants a pointer to mutable data even where it only reads.
cv::Mat view(const Spectrogram& spectrogram) {
  return {static_cast<int>(spectrogram.position_m.size()), static_cast<int>(spectrogram.bins), CV_32F,
          const_cast<float*>(spectrogram.cells.data())};
}

cv::Mat resized(const cv::Mat& power, int width, int height) {
  const bool shrinks = width <= power.cols && height <= power.rows;
  cv::Mat result;
  cv::resize(power, result, {width, height}, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
  return result;
}

// For each line of the picture the bin that it shows, as a fraction.
cv::Mat bins_by_line(double low_bin, double high_bin, int lines) {
  cv::Mat bins(lines, 1, CV_32F);
  for (int line = 0; line < lines; ++line) {
    const double part = (line + 0.5) / lines;
    bins.at<float>(line) = static_cast<float>(high_bin * std::pow(low_bin / high_bin, part));
  }
  return bins;
}

cv::Mat on_log_axis(const cv::Mat& power, double low_bin, double high_bin, int height) {
  const int lines = height * kLinesPerRow;
  cv::Mat columns(1, power.cols, CV_32F);
  for (int x = 0; x < power.cols; ++x) columns.at<float>(x) = static_cast<float>(x);
  const cv::Mat map_x = cv::repeat(columns, lines, 1);
  const cv::Mat map_y = cv::repeat(bins_by_line(low_bin, high_bin, lines), 1, power.cols);
  cv::Mat fine;
  cv::remap(power, fine, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return resized(fine, power.cols, height);
}

// 10 log10, to 0 ... 255 between the levels.
cv::Mat shades(const cv::Mat& power, const LevelReference& reference, const LevelRange& levels) {
  cv::Mat level;
  cv::log(cv::max(power, 1e-37F), level);
  const double scale = 255 / (levels.high_db - levels.low_db);
  const double to_db = reference.decade_db / std::log(10.0);
  const double shift = reference.decade_db * std::log10(reference.factor) - levels.low_db;
  cv::Mat shade;
  level.convertTo(shade, CV_8U, to_db * scale, shift * scale);
  return shade;
}

std::uint32_t packed(const cv::Vec3b& bgr) {
  return static_cast<std::uint32_t>(bgr[2]) << 16 | static_cast<std::uint32_t>(bgr[1]) << 8 | bgr[0];
}

Pixels coloured(const cv::Mat& shade) {
  cv::Mat bgr;
  cv::applyColorMap(shade, bgr, kColours);
  Pixels pixels{bgr.cols, bgr.rows, {}};
  pixels.rgb.resize(bgr.total());
  std::transform(bgr.begin<cv::Vec3b>(), bgr.end<cv::Vec3b>(), pixels.rgb.begin(), packed);
  return pixels;
}

}  // namespace

std::uint32_t level_pixel(double level_db, const LevelRange& levels) {
  const double part = (level_db - levels.low_db) / (levels.high_db - levels.low_db);
  const cv::Mat shade(1, 1, CV_8U, cv::Scalar(std::clamp(part, 0.0, 1.0) * 255));
  return coloured(shade).rgb[0];
}

Colour level_colour(double level_db, const LevelRange& levels) {
  const std::uint32_t rgb = level_pixel(level_db, levels);
  return {(rgb >> 16 & 0xFF) / 255.0, (rgb >> 8 & 0xFF) / 255.0, (rgb & 0xFF) / 255.0};
}

schema::Result<Pixels> heatmap(const Spectrogram& spectrogram, double low_per_m, double high_per_m,
                               const LevelRange& levels, int width, int height) try {
  cv::Mat power = view(spectrogram);
  const auto last = static_cast<double>(spectrogram.bins - 1);
  power = resized(power, std::min(power.cols, kMostBins), std::min(power.rows, width));
  power = resized(cv::Mat(power.t()), width, power.cols);
  const double shrunk = static_cast<double>(power.rows) / static_cast<double>(spectrogram.bins);
  const auto bin = [&](double per_m) {
    return (std::min(last, per_m / spectrogram.frequency_step_per_m) + 0.5) * shrunk - 0.5;
  };
  power = on_log_axis(power, bin(low_per_m), bin(high_per_m), height);
  return coloured(shades(power, level_reference(spectrogram), levels));
} catch (const cv::Exception& fault) {
  return schema::fail(schema::ErrorKind::internal, fault.what(), "picture");
}

}  // namespace tacto::spatial
