// SPDX-License-Identifier: GPL-3.0-or-later
// Height profiles of the samples A to E: Wiertlewski, Lozada, Hayward 2011, Table II. The table gives process
// and main dimension; the other properties (roughness, walls, spread) are our choice, noted at each constant.
#pragma once

#include <cstdint>
#include <vector>

namespace tacto::firmware_host {

/// Heights in metres at x = i * pitch_m.
using Heights = std::vector<double>;

/// A: melted by a handheld polishing disk. Long smooth waves of 1 to 5 mm, with a fine grain.
Heights melted_surface(std::size_t count, double pitch_m, std::uint64_t seed);
/// B: milled by an end mill of 40 mm with many teeth. Ridges 1.5 mm apart and 0.1 mm high, different for each
/// tooth.
Heights milled_ridges(std::size_t count, double pitch_m, std::uint64_t seed);
/// C: milled by an end mill of 2 mm with two flutes. A grating of 3 mm period, 0.1 mm deep.
Heights milled_grating(std::size_t count, double pitch_m, std::uint64_t seed);
/// D: coarse sandpaper, P40. Random scratches.
Heights sanded_scratches(std::size_t count, double pitch_m, std::uint64_t seed);
/// E: drilled by a conical end mill of 60 degrees. A quincunx of pits, 0.5 mm apart and 0.1 mm deep.
Heights drilled_pits(std::size_t count, double pitch_m, std::uint64_t seed);

}  // namespace tacto::firmware_host
