// SPDX-License-Identifier: GPL-3.0-or-later
// Searches random closed motions of the hand for one in which a virtual spring and damper are not passive.
#pragma once

#include <cstddef>
#include <cstdint>

#include "data-schema/device/device.hpp"
#include "playback/stability/sampled_spring.hpp"

namespace tacto::playback {

/// The least stiffness at which one of `paths` random closed motions receives more energy in a cycle than the
/// friction of the axis dissipates; infinity if none does. A cycle has up to 64 ticks: there and back in even
/// steps (cycles of one tick each way among them), random steps and back, or across one border of the
/// encoder. Places are read in counts, the force is held and delayed, the
/// speed of the damper is that of the kernel (core::EdgeSpeed), and no motion is faster than `speed_mps` (may
/// be infinite). The energy is affine in K, so each path has one K. Compare passive_stiffness_limit(): none
/// is below it without a damper. The same seed gives the same paths on every machine. Preconditions: the
/// encoder has a step; mass and period above 0.
double least_generating_stiffness(const schema::DeviceAxis& axis, const TickTiming& timing,
                                  double virtual_damping_n_s_per_m, double speed_mps, std::size_t paths,
                                  std::uint64_t seed);

}  // namespace tacto::playback
