// SPDX-License-Identifier: GPL-3.0-or-later
// The layers of a scene that act in each pixel of a picture, and the relief as hill shading.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/scene/patch.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "spatial/picture/draw/geometry.hpp"

namespace tacto::analysis {

// A patch in the plane: its corners, and which places it contains.

/// Places in metres, as spatial::Point with y upwards.
class PatchFrame {
 public:
  explicit PatchFrame(const schema::Patch& patch);

  /// From the patch's axes, from its centre, to the plane.
  spatial::Point in_plane(double u_m, double v_m) const;
  bool holds(spatial::Point place_m) const;
  /// Around the patch.
  std::array<spatial::Point, 4> corners() const;

 private:
  spatial::Point centre_m_;
  double half_width_m_, half_height_m_, cosine_, sine_;
};

/// Square pixels, from the top left: the centre of pixel (i, j) is at left_m + (i + 1/2) pixel_m, top_m -
/// (j + 1/2) pixel_m.
struct PixelGrid {
  double left_m = 0, top_m = 0, pixel_m = 1;
  int columns = 0, rows = 0;

  spatial::Point centre_m(int column, int row) const {
    return {left_m + (column + 0.5) * pixel_m, top_m - (row + 0.5) * pixel_m};
  }
};

/// A part of what acts in a pixel.
enum Acts : std::uint8_t { kActsRelief = 1, kActsSpring = 2, kActsDamper = 4 };

/// One of them, by the type of the layer.
std::uint8_t acts_of(const schema::ForceLayer& layer);

/// Row by row; as many values as the grid has pixels.
struct ReliefRaster {
  PixelGrid grid;
  std::vector<std::uint8_t> acts;           ///< Acts, added
  std::vector<float> force_x_n, force_y_n;  ///< of the relief, before the limits of the device
  double full_n = 0;                        ///< the force that is drawn as a slope of 1; 0: no relief
  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
           static_cast<std::size_t>(column);
  }
};

/// The relief is all that is neither spring (nor the spring of a body or a lasso) nor damper (nor mover):
/// grooves, noise, height maps, textures, fields, force maps. Its force is that of playback::ExactScene, the
/// reference of the kernel, on a hand that moves by one pixel in each tick: so frequencies of over half a
/// cycle in a pixel, which pixels cannot show, are left out by the same rule as in playback. Where patches
/// overlap, the topmost acts and those that are added. full_n is the force that 10 % of the pixels with a
/// relief exceed, at least a tenth of the largest. `rate_hz`: that for which the scene was prepared.
/// `progress` receives fractions.
ReliefRaster relief_raster(const playback::PreparedScene& scene, double rate_hz, const PixelGrid& grid,
                           const std::function<void(double)>& progress = {});

/// The direction to the light: from the upper left, 45 degrees above the plane. An angle of 112.5 degrees
/// from the x axis is parallel to no grooves at a multiple of 45 degrees.
inline constexpr double kLightX = -0.2705980500730985, kLightY = 0.6532814824381883,
                        kLightZ = 0.7071067811865476;

/// Lambert's law, 0 to 1, on a surface with the normal (F_x, F_y, full) / |...|: because F = -kappa grad h,
/// this is the relief with its heights times kappa / full. A plane has kLightZ.
double hill_shade(double force_x_n, double force_y_n, double full_n);

/// The colour of a pixel: white where nothing acts, grey by hill_shade() on a relief, and tints of springs
/// and dampers. At most 256 different colours, for an SVG with a palette.
spatial::Pixels shaded(const ReliefRaster& raster);

/// The colour of a place with this shade; `acts`: Acts, added.
std::uint32_t acting_colour(std::uint8_t acts, double shade);

}  // namespace tacto::analysis
