// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/paper_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "firmware-host/sim/physics/random.hpp"
#include "firmware-host/sim/physics/spline_noise.hpp"

namespace tacto::firmware_host {
namespace {

constexpr double kDepthM = 0.1e-3;  // B, C and E: Table II

// A: ours. Knots of 0.6 mm put the waves at 1 to 5 mm.
constexpr double kMeltedKnotM = 0.6e-3;
constexpr double kMeltedRmsM = 40e-6;
constexpr double kGrainKnotM = 0.1e-3;
constexpr double kGrainRmsM = 3e-6;

constexpr double kRidgeSpacingM = 1.5e-3;  // B: Table II
constexpr double kToothSpread = 0.1;       // ours: of the height, from tooth to tooth

constexpr double kGratingPeriodM = 3e-3;  // C: Table II
constexpr double kGratingWallM = 0.2e-3;  // ours: the width of a groove's wall, with burr
constexpr double kCutterMarkM = 2e-6;     // ours: the marks of the cutter on lands and grooves

// D: P40 grit is 425 um across (FEPA 43-1); spacing, depth and flank are ours.
constexpr double kScratchSpacingM = 0.425e-3;
constexpr double kScratchDepthM = 50e-6;
constexpr double kScratchFlank = 3;  // half width over depth

constexpr double kPitSpacingM = 0.5e-3;   // E: Table II
constexpr double kPitFlank = 0.57735027;  // radius over depth of a 60 degree cone: tan 30 degrees
constexpr double kDrillSpread = 0.05;     // ours: of the depth, from pit to pit
constexpr double kDrillWanderM = 10e-6;   // ours: of the place

double place(std::size_t i, double pitch_m) {
  return static_cast<double>(i) * pitch_m;
}

// Cuts a notch with straight flanks into the surface: depth d, half width d * flank.
void cut_notch(Heights& heights, double pitch_m, double centre_m, double depth_m, double flank) {
  const double reach = depth_m * flank;
  const double first = std::max(0.0, std::floor((centre_m - reach) / pitch_m));
  for (auto i = static_cast<std::size_t>(first); i < heights.size(); ++i) {
    const double away = std::abs(place(i, pitch_m) - centre_m);
    if (away < reach) heights[i] = std::min(heights[i], away / flank - depth_m);
    if (place(i, pitch_m) > centre_m + reach) return;
  }
}

// -1/2 in the groove, +1/2 on the land, straight walls; phase 0 to 1 is one period.
double trapezoid(double phase, double wall) {
  const double from_groove = 0.25 - std::abs(phase - 0.5);
  return std::clamp(from_groove / wall, -0.5, 0.5);
}

// Long smooth waves of 1 to 5 mm, with a fine grain.
Heights melted_surface(std::size_t count, double pitch_m, std::uint64_t seed) {
  SplineNoise waves(Random(seed, 1), kMeltedKnotM), grain(Random(seed, 2), kGrainKnotM);
  Heights heights(count);
  for (std::size_t i = 0; i < count; ++i)
    heights[i] = kMeltedRmsM * waves.at(place(i, pitch_m)) + kGrainRmsM * grain.at(place(i, pitch_m));
  return heights;
}

// An end mill of 40 mm with many teeth: each tooth makes a ridge of its own.
Heights milled_ridges(std::size_t count, double pitch_m, std::uint64_t seed) {
  Random random(seed, 3);
  Heights heights(count);
  double tooth = 0, depth_m = kDepthM;
  for (std::size_t i = 0; i < count; ++i) {
    const double period = std::floor(place(i, pitch_m) / kRidgeSpacingM);
    if (period > tooth) depth_m = kDepthM * (1 + kToothSpread * random.normal());
    tooth = std::max(tooth, period);
    const double from_middle = 2 * (place(i, pitch_m) / kRidgeSpacingM - period) - 1;
    heights[i] = depth_m * (from_middle * from_middle - 1);
  }
  return heights;
}

// An end mill of 2 mm with two flutes.
Heights milled_grating(std::size_t count, double pitch_m, std::uint64_t seed) {
  SplineNoise marks(Random(seed, 4), kGrainKnotM);
  Heights heights(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double periods = place(i, pitch_m) / kGratingPeriodM;
    const double shape = trapezoid(periods - std::floor(periods), kGratingWallM / kGratingPeriodM);
    heights[i] = kDepthM * shape + kCutterMarkM * marks.at(place(i, pitch_m));
  }
  return heights;
}

Heights sanded_scratches(std::size_t count, double pitch_m, std::uint64_t seed) {
  Random random(seed, 5);
  Heights heights(count, 0);
  const double length_m = place(count, pitch_m);
  const auto scratches = static_cast<std::size_t>(2 * length_m / kScratchSpacingM);
  for (std::size_t i = 0; i < scratches; ++i) {
    const double centre_m = length_m * random.uniform();
    const double size = random.normal();
    cut_notch(heights, pitch_m, centre_m, kScratchDepthM * std::abs(size), kScratchFlank);
  }
  return heights;
}

// A conical end mill of 60 degrees.
Heights drilled_pits(std::size_t count, double pitch_m, std::uint64_t seed) {
  Random random(seed, 6);
  Heights heights(count, 0);
  for (double centre_m = kPitSpacingM / 2; centre_m < place(count, pitch_m); centre_m += kPitSpacingM) {
    const double wander_m = kDrillWanderM * random.normal();
    const double depth_m = kDepthM * (1 + kDrillSpread * random.normal());
    cut_notch(heights, pitch_m, centre_m + wander_m, depth_m, kPitFlank);
  }
  return heights;
}

}  // namespace

std::span<const PaperSurface> paper_surfaces() {
  static constexpr PaperSurface kSurfaces[] = {
      {'A', "melted by a polishing disk", melted_surface},
      {'B', "milled ridges 1.5 mm apart, 0.1 mm high", milled_ridges},
      {'C', "milled grating of 3 mm period, 0.1 mm deep", milled_grating},
      {'D', "scratches of P40 sandpaper", sanded_scratches},
      {'E', "quincunx of conical pits 0.5 mm apart, 0.1 mm deep", drilled_pits},
  };
  return kSurfaces;
}

}  // namespace tacto::firmware_host
