// SPDX-License-Identifier: GPL-3.0-or-later
// What the emulated tray did in a pass, and what it was to do, both over time.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/fidelity/emulated_pass.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/physics/tray_physics.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::analysis {

/// Samples between two ticks, so that what a held drive brings above its own rate does not fold: 20 kHz at
/// least.
std::size_t samples_a_tick(double tick_rate_hz);

/// The pass's drive through the tray, integrated from its equations of motion (firmware_host::ActuatedTray),
/// m, at samples_a_tick() to each of the pass's positions.
std::vector<double> felt_displacement_m(const EmulatedPass& pass, const schema::Transducer& real,
                                        const firmware_host::TrayPhysics& physics);

/// The same, seen by a displacement sensor: the emulated LVDT (first-order low-pass, noise, 16 bits) over
/// twice the displacement limit, 5 kHz, 5 nm RMS of noise. These are ours: what sensors for such strokes are
/// sold with.
std::vector<double> through_sensor(const std::vector<double>& displacement_m, double rate_hz,
                                   const schema::Transducer& real);

/// gain x force at the finger's true places, by the exact reference, in the band.
std::vector<double> target_displacement_m(const EmulatedPass& pass, const schema::Texture& texture,
                                          double at_m, double gain_m_per_n, const spatial::Band& band);

/// A displacement in that band, cut as the reference is (playback::keep_band), so that what lies beside the
/// band is neither wanted nor an error.
std::vector<double> in_band(const std::vector<double>& displacement_m, double rate_hz,
                            const spatial::Band& band);

}  // namespace tacto::analysis
