// SPDX-License-Identifier: Apache-2.0
// The texture of a piece in space: a recorded force along the path of the point on its surface, or a map that
// turns the force of its wall, or a sine in it.
#pragma once

#include "firmware-host/core/scene/piece.hpp"

namespace tacto::core {

/// The line of a path turns to its way within about this length: counts of the encoder do not turn it to and
/// fro, and on a circle of 10 mm it lags by 0.03 rad.
inline constexpr float kPathLine_m = 3e-4F;

/// One tick of the texture of a piece, on a hand whose place on it is `place_m`: the force along the surface.
/// Call it before friction_force(), which sets the place of the last tick. Without a force along the normal
/// it is 0, and the texture stays where it is.
///
/// Recording: -gain f(s) along the line of the path, where s is the length of the path along this line; f is
/// read forth and back without an end, and levels of less detail at higher speeds (slope_of()). The line
/// turns to the way of the point (kPathLine_m). On the way back along the same line s falls, so that each
/// place has its force, as on a tray. The work along any path is gain times the difference of the integral of
/// f at its two ends: with a mean of 0 (prepare_pieces() subtracts it) a texture gives back what was put in,
/// and not more.
///
/// Bump: -gain normal_n grad h along the surface, with the height map h(u, v) projected on the surface across
/// its two axes (Massie 1996). The force along the normal stays. With a constant one the work along any
/// closed path is 0, on every shape, because h is a function of the place on the surface.
///
/// Normals: the force of the wall turned to the normal of the map, of the same size: normal_n (normal - gain
/// grad h) / |normal - gain grad h|, `normal_n` becomes its part along the normal. The surface is flat all
/// the same, so that this is no gradient: a hand that presses harder on the way down a hill than on the way
/// up gains energy (Massie 1996).
///
/// Sine: a sin(2 pi u / p) sin(2 pi v / q) is added to `normal_n`, along the same axes (Massie 1996), with
/// the gain x amplitude a; where the force of the wall is below |a| it takes the place of |a|, so that the
/// sum is not below 0 and begins with 0 at a contact. Frequencies above half the rate are not played
/// (held_by_rate()). Safe in the tick.
SpaceVector texture_force(const PieceTable& table, const float* number, WallState& state, float& normal_n,
                          SpaceVector normal, SpaceVector place_m, SpaceVector speed_mps,
                          float rate_hz) noexcept;

}  // namespace tacto::core
