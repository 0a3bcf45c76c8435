// SPDX-License-Identifier: GPL-3.0-or-later
// Height profiles of the samples A to E: Wiertlewski, Lozada, Hayward 2011, Table II. The table gives process
// and main dimension; the other properties (roughness, walls, spread) are our choice, noted at each constant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace tacto::firmware_host {

/// Heights in metres at x = i * pitch_m.
using Heights = std::vector<double>;

struct PaperSurface {
  char name;
  std::string_view description;
  /// `count` heights, pitch_m apart; the same seed gives the same ones.
  Heights (*heights)(std::size_t count, double pitch_m, std::uint64_t seed);
};

/// A to E, in this order.
std::span<const PaperSurface> paper_surfaces();

}  // namespace tacto::firmware_host
