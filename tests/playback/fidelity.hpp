// SPDX-License-Identifier: GPL-3.0-or-later
// Displacement under a finger against the texture's target: the kernel's drive through the integrated tray,
// and the exact reference along the same path.
#pragma once

#include <algorithm>
#include <complex>
#include <optional>

#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/prepare/texture_layout.hpp"
#include "playback/render/reference/exact_target.hpp"
#include "playback/render/reference/padded_spectrum.hpp"

namespace tacto::tests {

inline constexpr double kTrueCountM = 1e-9;  // so fine that its position is the finger's
inline constexpr double kLeftOutS = 0.2;     // at each end

struct FidelityCase {
  playback::PrepareOptions options;  ///< ends and seam are set for the loop
  schema::Transducer model;          ///< the transducer of the inverse
  schema::Transducer real;           ///< the transducer that moves
  firmware_host::TrayPhysics physics;
  playback::FingerPath path;
};

struct Fidelity {
  double error_db = 0;  ///< in the band, RMS re the target
  double error_um = 0;
  double target_um = 0;
  double delay_s = 0;  ///< of the filter
};

/// RMS in the band of the signal between the ends, with a Hann window.
inline double rms_in_band(std::span<const double> values, double rate_hz, const spatial::Band& band) {
  const auto skipped = static_cast<std::size_t>(kLeftOutS * rate_hz);
  std::vector<double> windowed(values.begin() + static_cast<std::ptrdiff_t>(skipped),
                               values.end() - static_cast<std::ptrdiff_t>(skipped));
  for (std::size_t i = 0; i < windowed.size(); ++i)
    windowed[i] *=
        1 - std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(windowed.size()));
  const auto spectrum = playback::spectrum_of(windowed, rate_hz, windowed.size());
  const auto n = static_cast<double>(windowed.size());
  return std::sqrt(2 * playback::energy_in(spectrum, band) / 1.5) / n;
}

/// Runs the kernel tick by tick, with an encoder of metres_per_count; the tray has `fine` steps per tick.
inline std::vector<double> displacement_at_finger(const FidelityCase& c, const playback::Prepared& prepared,
                                                  std::size_t ticks, std::size_t fine) {
  const auto positions = playback::positions_along(c.path, c.options.rate_hz, ticks);
  firmware_host::TrayPhysics physics = c.physics;
  if (c.options.reconstruction != playback::Reconstruction::none)
    physics.reconstruction_cutoff_hz = c.options.reconstruction_cutoff_hz;
  firmware_host::ActuatedTray tray(c.real, c.options.rate_hz * static_cast<double>(fine), physics);
  core::TickKernel kernel;
  kernel.set(prepared.setup());
  std::vector<double> displacement_m;
  for (const double position_m : positions) {
    const auto count = static_cast<std::int32_t>(std::floor(position_m / c.options.metres_per_count));
    const double drive_v = kernel.tick({count, prepared.gain_m_per_n, true, core::kNoForce}).drive_v;
    for (std::size_t i = 0; i < fine; ++i) displacement_m.push_back(tray.tick(drive_v));
  }
  return displacement_m;
}

inline schema::Result<Fidelity> fidelity_of(const schema::Texture& texture, FidelityCase c) {
  const playback::PlacedTexture placed{&texture, 0, 1};
  c.options.ends = playback::Ends::loop;
  const auto prepared = playback::prepare(std::span(&placed, 1), c.model, c.options);
  TACTO_TRY(prepared);
  const auto loop = playback::one_period(std::span(&placed, 1), playback::Ends::loop, c.options.seam_m);
  const double most = *std::ranges::max_element(c.path.position_m);
  const schema::SpaceSignal unrolled = playback::unrolled_loop(loop, most + 0.01);
  const auto fine = static_cast<std::size_t>(std::ceil(20e3 / c.options.rate_hz));
  const double rate_hz = c.options.rate_hz * static_cast<double>(fine);
  const double finest_hz = playback::highest_spatial_frequency(loop) * playback::greatest_speed_mps(c.path);
  // Content outside of the band is neither target nor error, so the reference extends beyond the band.
  const spatial::Band reference{10, c.options.band.high_hz * 1.01};
  const auto grid = playback::reading_grid(c.path.duration_s(), rate_hz, reference, finest_hz);
  const playback::TextureLookup lookup(unrolled, 0);
  const auto target = playback::signal_of(
      playback::exact_target(lookup, c.path, grid, reference, c.options.gain_m_per_n, 0.005));
  const auto at_finger = displacement_at_finger(c, *prepared, target.size() / fine, fine);
  std::vector<double> error(at_finger.size());
  for (std::size_t i = 0; i < error.size(); ++i) error[i] = at_finger[i] - target[i];
  const double target_m = rms_in_band(std::span(target).first(at_finger.size()), rate_hz, c.options.band);
  const double error_m = rms_in_band(error, rate_hz, c.options.band);
  return Fidelity{20 * std::log10(error_m / target_m), error_m * 1e6, target_m * 1e6, prepared->delay_s};
}

}  // namespace tacto::tests
