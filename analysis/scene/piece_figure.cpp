// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/scene/piece_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/base/quantity.hpp"
#include "data-schema/report/value_text.hpp"
#include "spatial/picture/draw/axes.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/draw/colours.hpp"
#include "spatial/picture/draw/display_unit.hpp"
#include "spatial/picture/draw/fitted_text.hpp"

namespace tacto::analysis {

using schema::Piece;
using schema::PieceShape;
using spatial::Canvas;
using spatial::Colour;
using spatial::Point;
using Place = std::array<double, 3>;

namespace {

constexpr double kSectionsWidth = 520, kSectionsMargin = 14, kSectionLeft = 62, kSectionHeight = 230,
                 kBelowSection = 60;
constexpr double kListLine = 13, kSwatch = 10, kListIndent = 18;
const spatial::TextStyle kSectionTitle{.size = 9.5, .bold = true}, kPieceWords{.size = 9};
const char* const kAxes[] = {"x", "y", "z"};

double inner(const Place& a, const Place& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Over the plane, at a place from that of the piece.
double height_m(const Piece& piece, const Place& p, const PieceReliefs& reliefs) {
  const auto found = schema::is_raised(piece) ? reliefs.find(piece.relief->file) : reliefs.end();
  if (found == reliefs.end()) return 0;
  const schema::HeightMap& map = found->second;
  const auto axes = relief_axes(piece);
  const auto samples = [&](std::size_t axis, std::size_t count) {
    const auto last = static_cast<double>(count - 1);
    return std::clamp(inner(axes[axis], p) / map.pitch_m + last / 2, 0.0, last);
  };
  const double x = samples(0, map.columns), y = samples(1, map.rows);
  const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
  const double right = x - static_cast<double>(i), up = y - static_cast<double>(j);
  const auto at = [&](std::size_t column, std::size_t row) {
    return double{
        map.height_m[std::min(row, map.rows - 1) * map.columns + std::min(column, map.columns - 1)]};
  };
  return (1 - up) * ((1 - right) * at(i, j) + right * at(i + 1, j)) +
         up * ((1 - right) * at(i, j + 1) + right * at(i + 1, j + 1));
}

bool is_solid(const Piece& piece, const Place& place_m, const PieceReliefs& reliefs,
              const PieceVolumes& volumes) {
  const Place p = {place_m[0] - piece.x_m, place_m[1] - piece.y_m, place_m[2] - piece.z_m};
  const double along = inner(piece.direction, p) / std::sqrt(inner(piece.direction, piece.direction));
  switch (piece.shape) {
    case PieceShape::plane:
      return along < height_m(piece, p, reliefs) && (piece.thickness_m == 0 || along > -piece.thickness_m);
    case PieceShape::sphere:
      return inner(p, p) < piece.radius_m * piece.radius_m;
    case PieceShape::cylinder:
      return inner(p, p) - along * along < piece.radius_m * piece.radius_m;
    case PieceShape::quadric:
      break;
    case PieceShape::mesh:
      return false;  // crossings()
    case PieceShape::volume: {
      schema::VolumeValue at;
      const auto found = volumes.find(piece.volume);
      return found != volumes.end() && value_at(found->second, p, at) && at.value > piece.iso;
    }
  }
  const auto& c = piece.coefficients;
  const auto [x, y, z] = p;
  return c[0] * x * x + c[1] * y * y + c[2] * z * z + c[3] * x * y + c[4] * y * z + c[5] * x * z + c[6] * x +
             c[7] * y + c[8] * z + c[9] <
         0;
}

Place place_of(const Piece& piece) {
  return {piece.x_m, piece.y_m, piece.z_m};
}

const schema::Mesh* mesh_of(const Piece& piece, const PieceMeshes& meshes) {
  const auto found = piece.shape == PieceShape::mesh ? meshes.find(piece.mesh) : meshes.end();
  return found == meshes.end() ? nullptr : &found->second;
}

// Where a line to the right at height `up`, within the section, passes through the mesh, in order.
std::vector<double> crossings(const Piece& piece, const schema::Mesh& mesh, const PieceSection& section,
                              double up, double across) {
  std::vector<double> found;
  const Place at = place_of(piece);
  for (const schema::MeshTriangle& triangle : mesh.triangles) {
    double u[3], v[3], right[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const schema::MeshVertex& corner = mesh.vertices_m[triangle[i]];
      u[i] = at[section.up] + corner[section.up] - up;
      v[i] = at[section.across] + corner[section.across] - across;
      right[i] = at[section.right] + corner[section.right];
    }
    if (std::min({u[0], u[1], u[2]}) > 0 || std::max({u[0], u[1], u[2]}) < 0) continue;
    const auto area = [&](std::size_t i, std::size_t j) { return u[i] * v[j] - u[j] * v[i]; };
    const double weight[3] = {area(1, 2), area(2, 0), area(0, 1)}, sum = weight[0] + weight[1] + weight[2];
    if (sum == 0 || weight[0] * sum < 0 || weight[1] * sum < 0 || weight[2] * sum < 0) continue;
    found.push_back((weight[0] * right[0] + weight[1] * right[1] + weight[2] * right[2]) / sum);
  }
  std::ranges::sort(found);
  return found;
}

Place middle_of(const PiecePicture& picture) {
  const schema::Scene& scene = picture.scene;
  const bool round =
      std::ranges::any_of(scene.pieces, [](const Piece& p) { return p.shape != PieceShape::plane; });
  Place sum = {};
  double count = 0;
  for (const Piece& piece : scene.pieces) {
    if (round && piece.shape == PieceShape::plane) continue;
    for (std::size_t i = 0; i < 3; ++i) sum[i] += place_of(piece)[i];
    if (const schema::Mesh* const mesh = mesh_of(piece, picture.meshes)) {
      const schema::MeshFigures figures = figures_of(*mesh);
      for (std::size_t i = 0; i < 3; ++i) sum[i] += (figures.least_m[i] + figures.most_m[i]) / 2;
    }
    ++count;
  }
  for (double& each : sum) each /= count;
  return sum;
}

PlaneRange range_of(const PiecePicture& picture, const PieceSection& section) {
  constexpr double kAround_m = 0.02;
  PlaneRange range;
  Place low = {}, high = {};
  for (const char* const name : kAxes) {
    if (!picture.device) break;
    const auto axis = std::ranges::find(picture.device->axes, name, &schema::DeviceAxis::name);
    const auto i = static_cast<std::size_t>(name[0] - 'x');
    if (axis != picture.device->axes.end()) low[i] = axis->travel_from_m, high[i] = axis->travel_to_m;
  }
  if (picture.device) {
    range.add({low[section.right], low[section.up]});
    range.add({high[section.right], high[section.up]});
    return range;
  }
  for (const Piece& piece : picture.scene.pieces) {
    const Place at = place_of(piece);
    if (const schema::Mesh* const mesh = mesh_of(piece, picture.meshes)) {
      const schema::MeshFigures figures = figures_of(*mesh);
      for (const auto& [end_m, around_m] :
           {std::pair{figures.least_m, -kAround_m}, {figures.most_m, kAround_m}})
        range.add({at[section.right] + end_m[section.right] + around_m,
                   at[section.up] + end_m[section.up] + around_m});
      continue;
    }
    Place half_m = {piece.radius_m, piece.radius_m, piece.radius_m};
    if (const auto volume = picture.volumes.find(piece.volume); volume != picture.volumes.end())
      half_m = volume->second.half_size_m();
    for (const double side : {-1.0, 1.0})
      range.add({at[section.right] + side * (half_m[section.right] + kAround_m),
                 at[section.up] + side * (half_m[section.up] + kAround_m)});
  }
  return range;
}

// Of a solid, inside its border.
Colour inside(const Colour& colour) {
  const auto light = [](double value) { return 1 - 0.25 * (1 - value); };
  return {light(colour.red), light(colour.green), light(colour.blue)};
}

std::uint32_t pixel_of(const Colour& colour) {
  const auto byte = [](double value) { return static_cast<std::uint32_t>(std::lround(255 * value)); };
  return byte(colour.red) << 16 | byte(colour.green) << 8 | byte(colour.blue);
}

std::string words_of(const Piece& piece) {
  std::string words = fmt::format("{}: {}", piece.name, to_string(piece.shape));
  const auto add = [&](const std::string& key, double value) {
    words += fmt::format(", {} {}", cli::labels_of({key}).front(),
                         spatial::typeset(cli::cell_text(key, cli::ReportPrinter::Value(value))));
  };
  if (piece.radius_m > 0) add("radius_m", piece.radius_m);
  if (piece.thickness_m > 0) add("thickness_m", piece.thickness_m);
  for (const schema::PieceNumber& each : schema::kWallNumbers) {
    const auto [name, number, changes, whole] = named_number(piece, each);
    if (number.value == Piece().*each.value && !number.slider) continue;
    add(each.name, number.value);
    if (number.slider) words += fmt::format(" (slider {:g} to {:g})", number.slider->from, number.slider->to);
  }
  if (piece.shape == PieceShape::volume) words += fmt::format(", {} above {:g}", piece.volume, piece.iso);
  if (piece.transient || piece.hand_surface) words += ", contact transient";
  if (!piece.travel.empty()) words += fmt::format(", travel of {} points", piece.travel.size());
  if (piece.texture)
    words += fmt::format(", texture {}{}{}", to_string(piece.texture->type),
                         piece.texture->file.empty() ? "" : " ", piece.texture->file);
  if (piece.slide)
    words += fmt::format(", slides {:g} to {:g} mm", 1e3 * piece.slide->from_m, 1e3 * piece.slide->to_m);
  if (piece.relief)
    words += fmt::format(", {} {}", piece.relief->interpolated ? "normals of" : "relief", piece.relief->file);
  return words;
}

}  // namespace

schema::Result<PiecePicture> read_piece_picture(schema::Scene scene, const std::string& where,
                                                const std::string& device) {
  PiecePicture picture;
  picture.name = scene.name.empty() ? where : scene.name;
  picture.scene = std::move(scene);
  for (const Piece& piece : picture.scene.pieces) {
    if (schema::is_raised(piece)) {
      auto map = schema::read_height_map(schema::texture_in_scene(where, piece.relief->file));
      TACTO_TRY(map);
      picture.reliefs[piece.relief->file] = std::move(*map);
    }
    if (piece.shape == PieceShape::volume && !picture.volumes.contains(piece.volume)) {
      auto volume = schema::read_volume(schema::texture_in_scene(where, piece.volume));
      TACTO_TRY(volume);
      picture.volumes[piece.volume] = std::move(*volume);
    }
    if (piece.shape != PieceShape::mesh || picture.meshes.contains(piece.mesh)) continue;
    auto mesh = schema::read_mesh(schema::texture_in_scene(where, piece.mesh));
    TACTO_TRY(mesh);
    picture.meshes[piece.mesh] = std::move(*mesh);
  }
  if (device.empty()) return picture;
  auto read = schema::read_device(device);
  TACTO_TRY(read);
  picture.device = std::move(*read);
  return picture;
}

spatial::Pixels section_pixels(const std::vector<int>& solid, const PixelGrid& grid) {
  spatial::Pixels pixels{grid.columns, grid.rows, {}};
  pixels.rgb.reserve(solid.size());
  const auto at = [&](int column, int row) {
    return solid[static_cast<std::size_t>(std::clamp(row, 0, grid.rows - 1)) *
                     static_cast<std::size_t>(grid.columns) +
                 static_cast<std::size_t>(std::clamp(column, 0, grid.columns - 1))];
  };
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const int here = at(column, row);
      const bool border = at(column - 1, row) != here || at(column + 1, row) != here ||
                          at(column, row - 1) != here || at(column, row + 1) != here;
      const Colour colour =
          here < 0 ? Colour{1, 1, 1} : spatial::series_colour(static_cast<std::size_t>(here));
      pixels.rgb.push_back(pixel_of(here < 0 || border ? colour : inside(colour)));
    }
  return pixels;
}

std::vector<int> solid_in_section(const schema::Scene& scene, const PixelGrid& grid, std::size_t across,
                                  const Place& through_m, const PieceMeshes& meshes,
                                  const PieceReliefs& reliefs, const PieceVolumes& volumes) {
  const PieceSection& section = *std::ranges::find(kPieceSections, across, &PieceSection::across);
  const double beside_m = 1e-6 * grid.pixel_m;  // of the section, so that it meets no vertex
  std::vector<int> solid;
  for (int row = 0; row < grid.rows; ++row) {
    std::map<std::size_t, std::vector<double>> of_meshes;
    for (std::size_t i = 0; i < scene.pieces.size(); ++i)
      if (const schema::Mesh* const mesh = mesh_of(scene.pieces[i], meshes))
        of_meshes[i] = crossings(scene.pieces[i], *mesh, section, grid.centre_m(0, row).y + beside_m,
                                 through_m[section.across] + beside_m);
    for (int column = 0; column < grid.columns; ++column) {
      const Point at = grid.centre_m(column, row);
      Place place_m = through_m;
      place_m[section.right] = at.x, place_m[section.up] = at.y;
      int last = -1;
      for (std::size_t i = 0; i < scene.pieces.size(); ++i)
        if (is_solid(scene.pieces[i], place_m, reliefs, volumes)) last = static_cast<int>(i);
      for (const auto& [i, at_m] : of_meshes)
        if ((std::ranges::lower_bound(at_m, at.x) - at_m.begin()) % 2 != 0)
          last = std::max(last, static_cast<int>(i));
      solid.push_back(last);
    }
  }
  return solid;
}

PieceFigure::PieceFigure(PiecePicture picture)
    : picture_(std::move(picture)), through_m_(picture_.through_m.value_or(middle_of(picture_))) {
  heading_ = spatial::heading_of(picture_.name, "Pieces of a scene in space: three sections", "",
                                 kSectionsWidth - 2 * kSectionsMargin);
  double top = kSectionsMargin + heading_.height() + kListLine;
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    maps_[i] = scene_map(range_of(picture_, kPieceSections[i]), {kSectionLeft, top},
                         {kSectionsWidth - kSectionLeft - kSectionsMargin, kSectionHeight});
    top = maps_[i].box.bottom() + kBelowSection;
  }
}

double PieceFigure::draw_list(Canvas& canvas) const {
  double y = maps_.back().box.bottom() + kBelowSection - kListLine;
  for (std::size_t i = 0; i < picture_.scene.pieces.size(); ++i) {
    const Colour colour = spatial::series_colour(i);
    const double top = y + (kListLine - kSwatch) / 2;
    canvas.fill({kSectionsMargin, top, kSwatch, kSwatch}, colour);
    canvas.fill({kSectionsMargin + 1, top + 1, kSwatch - 2, kSwatch - 2}, inside(colour));
    for (const std::string& line : spatial::wrapped(canvas, words_of(picture_.scene.pieces[i]), kPieceWords,
                                                    kSectionsWidth - 2 * kSectionsMargin - kListIndent)) {
      canvas.text({kSectionsMargin + kListIndent, y + kListLine / 2}, line, kPieceWords);
      y += kListLine;
    }
  }
  return y;
}

spatial::Size PieceFigure::page() const {
  Canvas ruler(spatial::PictureFormat::png, {1, 1});
  return {kSectionsWidth, std::ceil(draw_list(ruler) + kSectionsMargin)};
}

schema::Result<void> PieceFigure::draw(Canvas& canvas) const {
  draw_heading(canvas, {kSectionsMargin, kSectionsMargin}, heading_);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const PieceSection& section = kPieceSections[i];
    const SceneMap& map = maps_[i];
    canvas.text({map.box.x, map.box.y - kListLine / 2},
                fmt::format("{}, through {} = {}", section.from, kAxes[section.across],
                            spatial::typeset(schema::length_for_people(through_m_[section.across]))),
                kSectionTitle);
    canvas.image(map.box,
                 section_pixels(solid_in_section(picture_.scene, map.grid, section.across, through_m_,
                                                 picture_.meshes, picture_.reliefs, picture_.volumes),
                                map.grid));
    const auto count = [](double length) { return std::max(2, static_cast<int>(length / 45)); };
    canvas.frame(map.box, {});
    draw_axis(canvas, map.box, spatial::Side::bottom, map.x, ticks_of(map.x, count(map.box.width)));
    draw_axis(canvas, map.box, spatial::Side::left, map.y, ticks_of(map.y, count(map.box.height)));
    draw_caption(canvas, map.box, spatial::Side::bottom, fmt::format("{} (mm)", kAxes[section.right]), 26);
    draw_caption(canvas, map.box, spatial::Side::left, fmt::format("{} (mm)", kAxes[section.up]), 42);
  }
  draw_list(canvas);
  return {};
}

}  // namespace tacto::analysis
