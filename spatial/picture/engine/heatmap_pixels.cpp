// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/engine/engine_parts.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace tacto::spatial {
namespace {

constexpr int kColours = cv::COLORMAP_VIRIDIS;

// A pixel row near the top of the axis covers several bins: this many lines per row are sampled, then
// averaged.
constexpr int kLinesPerRow = 4;

// cv::remap uses 16-bit coordinates. More bins than this are averaged first; a page has far fewer rows.
constexpr int kMostBins = 30000;

// OpenCV requires a pointer to mutable data even if it only reads.
cv::Mat view(const HeatmapJob& job) {
  return {job.rows, job.bins, CV_32F, const_cast<float*>(job.cells.data())};
}

cv::Mat resized(const cv::Mat& power, int width, int height) {
  const bool shrinks = width <= power.cols && height <= power.rows;
  cv::Mat result;
  cv::resize(power, result, {width, height}, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
  return result;
}

// For each line of the picture, the fractional bin that it shows.
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

// 10 log10, mapped to 0 ... 255 between the levels of the job.
cv::Mat shades(const cv::Mat& power, const HeatmapJob& job) {
  cv::Mat level;
  cv::log(cv::max(power, 1e-37F), level);
  const double scale = 255 / (job.high_db - job.low_db);
  const double to_db = job.decade_db / std::log(10.0);
  const double shift = job.decade_db * std::log10(job.factor) - job.low_db;
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

std::uint32_t shade_pixel(double part) {
  const cv::Mat shade(1, 1, CV_8U, cv::Scalar(part * 255));
  return coloured(shade).rgb[0];
}

schema::Result<Pixels> heatmap_pixels(const HeatmapJob& job) try {
  cv::Mat power = view(job);
  power = resized(power, std::min(power.cols, kMostBins), std::min(power.rows, job.width));
  power = resized(cv::Mat(power.t()), job.width, power.cols);
  const double shrunk = static_cast<double>(power.rows) / static_cast<double>(job.bins);
  const auto row = [&](double bin) { return (bin + 0.5) * shrunk - 0.5; };
  power = on_log_axis(power, row(job.low_bin), row(job.high_bin), job.height);
  return coloured(shades(power, job));
} catch (const cv::Exception& fault) {
  return schema::fail(schema::ErrorKind::internal, fault.what(), "picture");
}

}  // namespace tacto::spatial
