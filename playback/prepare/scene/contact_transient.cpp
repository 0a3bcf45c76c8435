// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/contact_transient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::playback {

using schema::ContactTransient;

namespace {

double radians_per_s(const ContactTransient& transient) {
  return 2 * std::numbers::pi * transient.frequency_hz;
}

}  // namespace

schema::Result<core::TransientTable> transient_table(const std::optional<ContactTransient>& transient,
                                                     double rate_hz, const std::string& where) {
  if (!transient) return core::TransientTable();
  if (!(2 * transient->frequency_hz < rate_hz))
    return schema::fail(
        schema::ErrorKind::unsuitable,
        fmt::format("a transient of {:g} Hz cannot be played at {:g} Hz", transient->frequency_hz, rate_hz),
        where + "/transient/frequency_hz", fmt::format("give less than half the rate, {:g} Hz", rate_hz / 2));
  const double left = std::exp(-transient->decay_per_s / rate_hz),
               angle = radians_per_s(*transient) / rate_hz;
  return core::TransientTable{static_cast<float>(transient->amplitude_n_s_per_m),
                              static_cast<float>(left * std::cos(angle) - 1),
                              static_cast<float>(left * std::sin(angle))};
}

double transient_peak_n_s_per_m(const ContactTransient& transient) {
  const double a = transient.decay_per_s, w = radians_per_s(transient);
  return transient.amplitude_n_s_per_m * w / std::hypot(a, w) * std::exp(-a / w * std::atan(w / a));
}

double transient_stops_kg(const ContactTransient& transient) {
  const double a = transient.decay_per_s, w = radians_per_s(transient);
  return transient.amplitude_n_s_per_m * w / (a * a + w * w);
}

double transient_whole_to_mps(const ContactTransient& transient, const schema::Device& device) {
  double most_n = device.peak_force_n;
  for (const schema::DeviceAxis& axis : device.axes) most_n = std::min(most_n, axis.peak_force_n);
  return std::min(most_n / transient_peak_n_s_per_m(transient),
                  device.slew_n_per_s / (transient.amplitude_n_s_per_m * radians_per_s(transient)));
}

}  // namespace tacto::playback
