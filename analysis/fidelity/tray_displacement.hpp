// SPDX-License-Identifier: GPL-3.0-or-later
// Displacement of the emulated tray in a pass, and its target, both over time.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/fidelity/emulated_pass.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/physics/tray_physics.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::analysis {

/// Samples per tick: at least 20 kHz, so that the images of the held drive do not alias.
std::size_t samples_a_tick(double tick_rate_hz);

/// Displacement of the tray, m, for the drive of the pass, integrated from its equations of motion
/// (firmware_host::ActuatedTray); samples_a_tick() samples for each of the pass's positions.
std::vector<double> displacement_at_finger_m(const EmulatedPass& pass, const schema::Transducer& real,
                                             const firmware_host::TrayPhysics& physics);

/// The displacement as a sensor measures it: the emulated LVDT (first-order low-pass, noise, 16 bits) over
/// twice the displacement limit, 5 kHz, 5 nm RMS of noise. We chose these values; they are usual for sensors
/// of such strokes.
std::vector<double> through_sensor(const std::vector<double>& displacement_m, double rate_hz,
                                   const schema::Transducer& real);

/// gain x force at the finger's exact positions, by the exact reference, in the band.
std::vector<double> target_displacement_m(const EmulatedPass& pass, const schema::Texture& texture,
                                          double at_m, double gain_m_per_n, const spatial::Band& band);

/// A displacement in that band, filtered as the reference is (playback::keep_band), so that the parts outside
/// of the band are neither target nor error.
std::vector<double> in_band(const std::vector<double>& displacement_m, double rate_hz,
                            const spatial::Band& band);

}  // namespace tacto::analysis
