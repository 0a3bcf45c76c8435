// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/sensor_samples.hpp"

#include <cmath>
#include <utility>

namespace tacto::playback {

SensorSamples::SensorSamples(const SessionOverview& overview) : overview_(overview) {
  if (!overview.header.sensor) return;
  auto reader = schema::SessionReader::open(overview.path);
  if (reader) reader_ = std::move(*reader);
}

void SensorSamples::take(const schema::SessionSamples& samples) {
  const schema::SessionSensor& sensor = *overview_.header.sensor;
  for (std::size_t i = 0; i < samples.codes.size(); ++i) {
    const SensorFrame frame{
        samples.first_frame + i,
        1e-9 * static_cast<double>(samples.time_ns) + static_cast<double>(i) / sensor.rate_hz,
        sensor.physical(samples.codes[i])};
    const bool grows =
        frames_.empty() || (frame.number > frames_.back().number && frame.time_s > frames_.back().time_s);
    sound_ = sound_ && grows;
    if (grows) frames_.push_back(frame);
  }
}

void SensorSamples::read_to(double time_s) {
  while (reader_ && (frames_.empty() || frames_.back().time_s <= time_s)) {
    const auto block = reader_->next();
    if (!block) return reader_.reset();
    if (const auto* samples = std::get_if<schema::SessionSamples>(&*block)) take(*samples);
  }
}

void SensorSamples::forget_before(double time_s) {
  while (frames_.size() > 1 && frames_[1].time_s < time_s) frames_.pop_front();
}

std::optional<double> SensorSamples::at(double time_s) {
  if (!overview_.header.sensor) return std::nullopt;
  read_to(time_s);
  forget_before(time_s);
  const double most_s = 0.5 / overview_.header.sensor->rate_hz;
  std::optional<double> nearest_m;
  double nearest_s = most_s;
  for (std::size_t i = 0; i < std::min<std::size_t>(frames_.size(), 3); ++i) {
    const double away_s = std::abs(frames_[i].time_s - time_s);
    if (away_s > nearest_s) continue;
    nearest_s = away_s;
    nearest_m = frames_[i].displacement_m;
  }
  return nearest_m;
}

}  // namespace tacto::playback
