// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/fidelity/tray_displacement.hpp"

#include <algorithm>
#include <cmath>

#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "firmware-host/sim/bench/lvdt.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/render/reference/exact_target.hpp"

namespace tacto::analysis {
namespace {

constexpr double kTrayRateHz = 20e3;
constexpr firmware_host::LvdtParameters kTraySensor{0, 5e3, 5e-9};

}  // namespace

std::size_t samples_a_tick(double tick_rate_hz) {
  return static_cast<std::size_t>(std::ceil(kTrayRateHz / tick_rate_hz));
}

std::vector<double> displacement_at_finger_m(const EmulatedPass& pass, const schema::Transducer& real,
                                             const firmware_host::TrayPhysics& physics) {
  const double rate_hz = pass.columns.header.rate_hz;
  const std::size_t fine = samples_a_tick(rate_hz);
  firmware_host::ActuatedTray tray(real, rate_hz * static_cast<double>(fine), physics);
  std::vector<double> displacement_m;
  for (std::size_t tick = 0; tick < pass.position_m.size(); ++tick)
    for (std::size_t i = 0; i < fine; ++i) displacement_m.push_back(tray.tick(pass.columns.drive_v[tick]));
  return displacement_m;
}

std::vector<double> through_sensor(const std::vector<double>& displacement_m, double rate_hz,
                                   const schema::Transducer& real) {
  firmware_host::LvdtParameters parameters = kTraySensor;
  parameters.range_m = 4 * real.displacement_limit_m;
  firmware_host::Lvdt sensor(parameters, 0, 0, rate_hz, true, firmware_host::Random(1, 1));
  std::vector<double> seen_m;
  for (const double place_m : displacement_m)
    seen_m.push_back(sensor.step(place_m) * sensor.converter().scale());
  return seen_m;
}

std::vector<double> target_displacement_m(const EmulatedPass& pass, const schema::Texture& texture,
                                          double at_m, double gain_m_per_n, const spatial::Band& band) {
  const double rate_hz = pass.columns.header.rate_hz;
  const auto fine = static_cast<double>(samples_a_tick(rate_hz));
  const playback::FingerPath path = playback::finger_path_of({rate_hz, 0, pass.position_m});
  const double finest_hz =
      playback::highest_spatial_frequency(texture.signal) * playback::greatest_speed_mps(path);
  const auto grid = playback::reading_grid(path.duration_s(), rate_hz * fine, band, finest_hz);
  const playback::TextureLookup lookup(texture.signal, at_m);
  return playback::signal_of(
      playback::exact_target(lookup, path, grid, band, gain_m_per_n, playback::kReferenceOnsetS));
}

std::vector<double> in_band(const std::vector<double>& displacement_m, double rate_hz,
                            const spatial::Band& band) {
  const double duration_s = static_cast<double>(displacement_m.size()) / rate_hz;
  const auto grid = playback::reading_grid(duration_s, rate_hz, band, 0);
  auto spectrum = playback::spectrum_of(displacement_m, rate_hz, grid.period);
  playback::keep_band(spectrum, band);
  return playback::signal_of(spectrum);
}

}  // namespace tacto::analysis
