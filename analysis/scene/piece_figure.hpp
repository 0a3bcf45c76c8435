// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of a scene of pieces in space: three sections through one place, along the axes.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/scene/scene_map.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/volume/volume.hpp"
#include "spatial/picture/draw/heading.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::analysis {

/// By the member `mesh` of the pieces.
using PieceMeshes = std::map<std::string, schema::Mesh>;
/// By the member `volume`.
using PieceVolumes = std::map<std::string, schema::Volume>;

/// By the file of a relief.
using PieceReliefs = std::map<std::string, schema::HeightMap>;

/// A scene of pieces; without a device the sections show 20 mm around all pieces.
struct PiecePicture {
  std::string name;  ///< of the scene, for the title
  schema::Scene scene;
  std::optional<schema::Device> device;            ///< whose travel is shown
  std::optional<std::array<double, 3>> through_m;  ///< default: the middle of the balls, pipes and quadrics
  PieceMeshes meshes = {};
  PieceReliefs reliefs = {};
  PieceVolumes volumes = {};
};

/// Axes, 0 to 2, to the right and up on the page, and across it.
struct PieceSection {
  std::size_t right, up, across;
  const char* from;
};
inline constexpr PieceSection kPieceSections[] = {
    {0, 1, 2, "from above"}, {0, 2, 1, "from the front"}, {1, 2, 0, "from the side"}};

/// Adds the meshes, reliefs and volumes, which are found beside the scene's file `where`, and the device, if
/// it has a name. Errors: as read_mesh, read_height_map, read_volume and read_device.
schema::Result<PiecePicture> read_piece_picture(schema::Scene scene, const std::string& where,
                                                const std::string& device);

/// In a section across axis `across`, 0 to 2: which piece is solid in each pixel, from 0 on, or -1. Where
/// several are, it is the last one. Pieces are drawn as they are, without the radius of the point. A mesh
/// with holes is not everywhere drawn as the solid that it is for the hand. The heights of a relief are drawn
/// straight from sample to sample.
std::vector<int> solid_in_section(const schema::Scene& scene, const PixelGrid& grid, std::size_t across,
                                  const std::array<double, 3>& through_m, const PieceMeshes& meshes = {},
                                  const PieceReliefs& reliefs = {}, const PieceVolumes& volumes = {});

/// Solid pieces in a light colour, as solid_in_section() gives them; pixels at their borders in the full one.
spatial::Pixels section_pixels(const std::vector<int>& solid, const PixelGrid& grid);

class PieceFigure : public spatial::Figure {
 public:
  explicit PieceFigure(PiecePicture picture);

  spatial::Size page() const override;
  schema::Result<void> draw(spatial::Canvas& canvas) const override;

  const std::array<double, 3>& through_m() const { return through_m_; }
  const SceneMap& map(std::size_t section) const { return maps_.at(section); }

 private:
  double draw_list(spatial::Canvas& canvas) const;  ///< returns its lower end

  PiecePicture picture_;
  std::array<double, 3> through_m_ = {};
  spatial::Heading heading_;
  std::array<SceneMap, 3> maps_;  ///< from above, from the front, from the side
};

}  // namespace tacto::analysis
