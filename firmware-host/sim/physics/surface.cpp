// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data-schema/base/quantity.hpp"
#include "data-schema/texture/texture.hpp"
#include "firmware-host/sim/physics/paper_surfaces.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::for_people;

constexpr double kPitchM = 2e-6;
constexpr double kDefaultPeriodM = 1.0e-3;  // the grating of Wiertlewski 2011, Figure 1
constexpr double kDefaultDepthM = 0.1e-3;   // the same
constexpr double kSquareWallM = 20e-6;      // a wall on a grid needs some width
constexpr double kShortestPeriodM = 50e-6;
constexpr double kShortestM = 10e-3;  // a patch of 4.4 mm needs room to move
constexpr double kLongestM = 1;

// One period of a grating for phase 0 to 1, between -1/2 and 1/2.
struct Grating {
  std::string_view name;
  double (*shape)(double phase, double period_m);
};

double sine(double phase, double) {
  return std::sin(2 * std::numbers::pi * phase) / 2;
}
double triangle(double phase, double) {
  return std::abs(2 * phase - 1) - 0.5;
}
double square(double phase, double period_m) {
  const double from_groove_m = (0.25 - std::abs(phase - 0.5)) * period_m;
  return std::clamp(from_groove_m / kSquareWallM, -0.5, 0.5);
}

constexpr Grating kGratings[] = {{"sine", sine}, {"triangle", triangle}, {"square", square}};

schema::Result<void> check_sizes(const SurfaceChoice& choice) {
  if (!(choice.length_m >= kShortestM && choice.length_m <= kLongestM))
    return schema::fail(ErrorKind::usage, "the length of the surface is not between 10 mm and 1 m", "length");
  if (choice.period_m && !(*choice.period_m >= kShortestPeriodM))
    return schema::fail(ErrorKind::usage, "the grating's period is below 50 um", "period");
  if (choice.depth_m && !(*choice.depth_m >= 0 && *choice.depth_m <= 1e-3))
    return schema::fail(ErrorKind::usage, "the grating's depth is not between 0 and 1 mm", "depth");
  return {};
}

std::size_t grid_points(const SurfaceChoice& choice) {
  return static_cast<std::size_t>(std::floor(choice.length_m / kPitchM + 0.5)) + 1;
}

Surface make_grating(const Grating& grating, const SurfaceChoice& choice) {
  const double period_m = choice.period_m.value_or(kDefaultPeriodM);
  const double depth_m = choice.depth_m.value_or(kDefaultDepthM);
  Heights heights(grid_points(choice));
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double periods = static_cast<double>(i) * kPitchM / period_m;
    heights[i] = depth_m * grating.shape(periods - std::floor(periods), period_m);
  }
  return {HeightProfile(kPitchM, heights),
          fmt::format("{} grating of {} period, {} deep", grating.name,
                      for_people(period_m, Dimension::length), for_people(depth_m, Dimension::length))};
}

constexpr std::string_view kProfilePrefix = "profile:";
constexpr double kCoarsestM = 0.1e-3;  // the width of a skin ridge's contact: FingerParameters
constexpr double kTallestM = 1e-3;     // as the gratings

tl::unexpected<schema::Error> no_profile(const std::string& name, std::string what, std::string remedy) {
  return schema::fail(ErrorKind::unsuitable, std::move(what), name, std::move(remedy));
}

// A measured texture of heights is used without smoothing or resampling.
schema::Result<Surface> measured_surface(const std::string& name) {
  const auto texture = schema::read_texture(name);
  TACTO_TRY(texture);
  if (texture->quantity != "height")
    return no_profile(name, fmt::format("is a texture of {}, not of heights", texture->quantity),
                      "make one with 'tactograph import' of a height profile");
  const double pitch_m = texture->signal.pitch_m, length_m = texture->signal.length_m();
  if (!(length_m >= kShortestM && length_m <= kLongestM))
    return no_profile(name, "has a length that is not between 10 mm and 1 m",
                      "use a longer or shorter profile");
  const Heights& heights = texture->signal.values;
  const auto [low, high] = std::ranges::minmax_element(heights);
  if (!(pitch_m <= kCoarsestM) || *high - *low > kTallestM)
    return no_profile(name, "its heights are more than 0.1 mm apart, or differ by more than 1 mm",
                      "use a smoother profile: a finger cannot follow it");
  const std::string words = texture->surface.empty() ? name : texture->surface;
  return Surface{HeightProfile(pitch_m, heights), fmt::format("profile of {}", words)};
}

schema::Result<Surface> make_fixed(const SurfaceChoice& choice) {
  if (choice.period_m || choice.depth_m)
    return schema::fail(ErrorKind::usage, fmt::format("surface {} has a fixed shape", choice.name),
                        "period, depth", "use period and depth with sine, triangle or square only");
  for (const PaperSurface& surface : paper_surfaces())
    if (choice.name == std::string_view(&surface.name, 1))
      return Surface{HeightProfile(kPitchM, surface.heights(grid_points(choice), kPitchM, choice.seed)),
                     fmt::format("{}: {}", surface.name, surface.description)};
  if (choice.name.starts_with(kProfilePrefix))
    return measured_surface(choice.name.substr(kProfilePrefix.size()));
  if (choice.name == "flat") return Surface{HeightProfile(kPitchM, Heights(grid_points(choice))), "flat"};
  return schema::fail(ErrorKind::usage, fmt::format("there is no surface '{}'", choice.name), "surface",
                      "the surfaces are: " + surface_names() + ", profile:FILE");
}

}  // namespace

std::string surface_names() {
  std::string names;
  for (const PaperSurface& surface : paper_surfaces()) names += fmt::format("{}, ", surface.name);
  return names + "flat, sine, triangle, square";
}

schema::Result<Surface> make_surface(const SurfaceChoice& choice) {
  TACTO_TRY(check_sizes(choice));
  for (const Grating& grating : kGratings)
    if (grating.name == choice.name) return make_grating(grating, choice);
  return make_fixed(choice);
}

}  // namespace tacto::firmware_host
