// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/hjif.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/lagrange.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::schema {
namespace {

constexpr double kMicrometre = 1e-6;
constexpr int kLargestStepUm = 100, kLeastUm = 10;
constexpr int kTimescale = 48000;  // obligatory, and without a meaning for positions; the largest allowed
constexpr int kHighestHz = 1000;   // of a band, obligatory: the largest allowed

struct Point {
  double x = 0, y = 0;
};

// Cubic through the four samples around a position: for 100 samples per period its error is below 1e-6.
double value_at(const SpaceSignal& texture, double position_m) {
  const auto& f = texture.values;
  const double at = position_m / texture.pitch_m;
  const auto last = static_cast<std::ptrdiff_t>(f.size()) - 4;
  const auto first = std::clamp(static_cast<std::ptrdiff_t>(std::floor(at)) - 1, std::ptrdiff_t{0}, last);
  const auto sample = [&](int i) { return f[static_cast<std::size_t>(first + i)]; };
  return lagrange<4>({0, 1, 2, 3}, {sample(0), sample(1), sample(2), sample(3)},
                     at - static_cast<double>(first));
}

// Slopes at the points. Two slopes are extrapolated beyond each end. Where the curve is straight on both
// sides, the formula is 0 / 0, and the mean of the outer slopes is taken.
std::vector<double> akima_slopes(std::span<const Point> points) {
  const std::size_t n = points.size();
  std::vector<double> m(n + 3);
  for (std::size_t i = 0; i + 1 < n; ++i)
    m[i + 2] = (points[i + 1].y - points[i].y) / (points[i + 1].x - points[i].x);
  m[1] = 2 * m[2] - m[3], m[0] = 2 * m[1] - m[2];
  m[n + 1] = 2 * m[n] - m[n - 1], m[n + 2] = 2 * m[n + 1] - m[n];
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    largest = std::max(largest, std::abs(m[i + 3] - m[i + 2]) + std::abs(m[i + 1] - m[i]));
  std::vector<double> slopes(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double after = std::abs(m[i + 3] - m[i + 2]), before = std::abs(m[i + 1] - m[i]);
    slopes[i] = after + before > 1e-9 * largest ? (after * m[i + 1] + before * m[i + 2]) / (after + before)
                                                : 0.5 * (m[i] + m[i + 3]);
  }
  return slopes;
}

std::vector<Point> keyframes_of(const SpaceSignal& texture, int step_um, int length_um, double peak) {
  std::vector<Point> points;
  const auto add = [&](int at_um) {
    const double amplitude = std::clamp(value_at(texture, at_um * kMicrometre) / peak, -1.0, 1.0);
    points.push_back({static_cast<double>(at_um), static_cast<double>(static_cast<float>(amplitude))});
  };
  for (int at_um = 0; at_um < length_um; at_um += step_um) add(at_um);
  add(length_um);
  return points;
}

double error_of(const SpaceSignal& texture, std::span<const Point> points, double peak) {
  const std::vector<double> slopes = akima_slopes(points);
  double error2 = 0, square = 0;
  std::size_t interval = 0;
  for (std::size_t i = 0; i < texture.values.size(); ++i) {
    const double x = static_cast<double>(i) * texture.pitch_m / kMicrometre;
    if (x > points.back().x) break;
    while (interval + 2 < points.size() && points[interval + 1].x < x) ++interval;
    const Point a = points[interval], b = points[interval + 1];
    const double h = b.x - a.x, u = (x - a.x) / h, v = 1 - u;
    const double curve = v * v * ((1 + 2 * u) * a.y + u * h * slopes[interval]) +
                         u * u * ((1 + 2 * v) * b.y - v * h * slopes[interval + 1]);
    error2 += std::pow(peak * curve - texture.values[i], 2);
    square += std::pow(texture.values[i], 2);
  }
  return std::sqrt(error2 / square);
}

std::string text_of(std::span<const Point> points, double peak, const std::string& description) {
  using Json = nlohmann::ordered_json;
  Json keyframes = Json::array();
  for (const Point& point : points)  // as many digits as a single-precision number has
    keyframes.push_back(
        {{"relative_position", static_cast<int>(point.x)},
         {"amplitude_modulation", std::stod(fmt::format("{}", static_cast<float>(point.y)))}});
  const Json effect = {{"effect_type", "Basis"},
                       {"position", 0},
                       {"phase", 0.0},
                       {"base_signal", "Sine"},
                       {"keyframes", keyframes}};
  const Json band = {{"band_type", "Curve"},
                     {"curve_type", "Akima"},
                     {"lower_frequency_limit", 0},
                     {"upper_frequency_limit", kHighestHz},
                     {"effects", Json::array({effect})}};
  const Json channel = {{"id", 0},
                        {"description", "tangential force; the gain is its peak in N"},
                        {"gain", peak},
                        {"mixing_coefficient", 1.0},
                        {"body_part_mask", 0},
                        {"bands", Json::array({band})}};
  const Json perception = {{"id", 0},
                           {"avatar_id", 0},
                           {"description", description},
                           {"perception_modality", "Vibrotactile Texture"},
                           {"unit_exponent", -6},
                           {"reference_devices", Json::array()},
                           {"effect_library", Json::array()},
                           {"channels", Json::array({channel})}};
  const Json file = {{"version", "2023"},
                     {"profile", "Main"},
                     {"level", 1},
                     {"date", creation_time().substr(0, 10)},
                     {"description", description},
                     {"timescale", kTimescale},
                     {"avatars", Json::array()},
                     {"perceptions", Json::array({perception})},
                     {"syncs", Json::array()}};
  return file.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Result<Hjif> hjif_of(const Texture& texture, const std::string& description, double max_error) {
  const SpaceSignal& signal = texture.signal;
  Hjif hjif;
  if (texture.unit != "N")
    return fail(ErrorKind::unsuitable, fmt::format("is a texture of {}, not of force", texture.quantity),
                description, "name a texture of force");
  // A length of 35 mm may be 34.9999999 mm in floating point.
  const int length_um = static_cast<int>(std::floor(signal.length_m() / kMicrometre + 1e-6));
  if (length_um < kLeastUm || signal.values.size() < 4)
    return fail(ErrorKind::unsuitable, fmt::format("is {} long", length_for_people(signal.length_m())),
                description, fmt::format("name a texture of at least {} um", kLeastUm));
  for (const double value : signal.values) hjif.peak_n = std::max(hjif.peak_n, std::abs(value));
  if (!(hjif.peak_n > 0))
    return fail(ErrorKind::unsuitable, "has only zeros", description, "name another texture");
  std::vector<Point> points;
  for (int step_um = std::min(kLargestStepUm, length_um / 4); step_um > 0; --step_um) {
    points = keyframes_of(signal, step_um, length_um, hjif.peak_n);
    hjif.step_um = step_um;
    hjif.error = error_of(signal, points, hjif.peak_n);
    if (hjif.error <= max_error) break;
  }
  if (!(hjif.error <= max_error))
    return fail(ErrorKind::unsuitable,
                fmt::format("has an error of {:.3g} % with keyframes every micrometre, which is the closest",
                            100 * hjif.error),
                description, fmt::format("allow a larger error: --max-error {:.2g}%", 110 * hjif.error));
  hjif.keyframes = points.size();
  hjif.length_m = length_um * kMicrometre;
  hjif.text = text_of(points, hjif.peak_n, description);
  return hjif;
}

}  // namespace tacto::schema
