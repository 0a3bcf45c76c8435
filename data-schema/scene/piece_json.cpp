// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/piece_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<std::string_view, 6> kShapeWords = {"plane",   "sphere", "cylinder",
                                                         "quadric", "mesh",   "volume"};
constexpr std::array<std::string_view, 4> kTextureWords = {"recording", "bump", "sine", "normals"};

// Before the numbers of the wall; each is written if it is not 0.
constexpr PieceNumber kShapeNumbers[] = {{"thickness_m", &Piece::thickness_m},
                                         {"radius_m", &Piece::radius_m}};

void read_wall(Piece& piece, const Json& body) {
  for (const auto& [name, value, changes] : kWallNumbers) {
    const auto at = body.find(name);
    if (at == body.end()) continue;
    piece.*value = at->is_object() ? (*at)["value"] : *at;
    if (at->is_object()) piece.sliders[name] = {(*at)["slider"]["from"], (*at)["slider"]["to"]};
  }
  if (body.contains("kinetic_friction")) return;
  const auto fixed = piece.sliders.find("static_friction");
  piece.kinetic_friction = fixed == piece.sliders.end() ? piece.static_friction : fixed->second.from;
}

void write_wall(const Piece& piece, Json& body) {
  for (const PieceNumber& each : kWallNumbers) {
    const auto [name, number, changes, whole] = named_number(piece, each);
    if (number.slider)
      body[each.name] = {{"value", number.value},
                         {"slider", {{"from", number.slider->from}, {"to", number.slider->to}}}};
    else if (number.value != Piece().*each.value || each.value == &Piece::stiffness_n_per_m ||
             (each.value == &Piece::kinetic_friction && piece.static_friction > 0))
      body[each.name] = number.value;
  }
}

void read_axes(std::array<std::array<double, 3>, 2>& axes, const Json& body) {
  if (!body.contains("axes")) return;
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::size_t j = 0; j < 3; ++j) axes[i][j] = body["axes"][i][j];
}

PieceTexture piece_texture_from(const Json& body) {
  PieceTexture texture;
  const auto type = std::ranges::find(kTextureWords, text_or(body, "type"));
  texture.type = static_cast<PieceTextureType>(type - kTextureWords.begin());
  texture.file = text_or(body, "file");
  read_axes(texture.axes, body);
  if (body.contains("periods_m")) texture.periods_m = {body["periods_m"][0], body["periods_m"][1]};
  texture.amplitude_n = number_or(body, "amplitude_n", 0);
  return texture;
}

Json piece_texture_body(const PieceTexture& texture) {
  Json body = {{"type", to_string(texture.type)}};
  if (texture.type == PieceTextureType::sine)
    body["periods_m"] = texture.periods_m, body["amplitude_n"] = texture.amplitude_n;
  else
    body["file"] = texture.file;
  if (texture.type != PieceTextureType::recording) body["axes"] = texture.axes;
  return body;
}

}  // namespace

std::string_view to_string(PieceShape shape) {
  return kShapeWords[static_cast<std::size_t>(shape)];
}

std::string_view to_string(PieceContact contact) {
  return contact == PieceContact::add ? "add" : "ghost";
}

std::string_view to_string(PieceTextureType type) {
  return kTextureWords[static_cast<std::size_t>(type)];
}

std::array<std::array<double, 3>, 2> map_axes(const std::array<std::array<double, 3>, 2>& axes) {
  auto [u, v] = axes;
  const double first = std::hypot(u[0], u[1], u[2]);
  for (double& part : u) part /= first;
  const double shared = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  for (std::size_t i = 0; i < 3; ++i) v[i] -= shared * u[i];
  const double second = std::hypot(v[0], v[1], v[2]);
  for (double& part : v) part /= second;
  return {u, v};
}

std::array<std::array<double, 3>, 2> relief_axes(const Piece& plane) {
  auto axes = plane.relief->axes;
  const auto& d = plane.direction;
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  for (auto& axis : axes) {
    const double along = (axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2]) / square;
    for (std::size_t i = 0; i < 3; ++i) axis[i] -= along * d[i];
  }
  return map_axes(axes);
}

double detent_stiffness_n_per_m(const PieceSlide& slide) {
  return slide.detent_m > 0 ? 2 * std::numbers::pi * slide.detent_n / slide.detent_m : 0;
}

double steepest_spring_n_per_m(const Piece& piece) {
  double steepest = piece.steepness * piece.stiffness_n_per_m;
  TravelPoint last;
  for (const TravelPoint& point : piece.travel) {
    if (point.depth_m > last.depth_m)
      steepest = std::max(steepest, (point.force_n - last.force_n) / (point.depth_m - last.depth_m));
    last = point;
  }
  return steepest;
}

NamedLayerNumber named_number(const Piece& piece, const PieceNumber& number) {
  NamedLayerNumber named{number.name, {piece.*number.value}, number.changes};
  if (const auto at = piece.sliders.find(number.name); at != piece.sliders.end())
    named.number.slider = at->second;
  return named;
}

std::vector<Piece> slider_ends(const Piece& piece) {
  if (piece.sliders.empty()) return {piece};
  std::vector<Piece> ends(4, piece);
  for (const PieceNumber& number : kWallNumbers) {
    const LayerNumber with = named_number(piece, number).number;
    const bool damps = number.value == &Piece::damping_n_s_per_m || number.value == &Piece::viscous_n_s_per_m;
    const bool stiffens = number.value == &Piece::stiffness_n_per_m;
    for (std::size_t i = 0; i < ends.size(); ++i)
      ends[i].*number.value =
          (damps && i % 2 == 0) || (stiffens && i >= 2) ? least_value(with) : farthest_value(with);
  }
  for (Piece& end : ends) end.sliders.clear();
  return ends;
}

Piece piece_from(const Json& body) {
  Piece piece;
  piece.name = text_or(body, "name");
  const auto shape = std::ranges::find(kShapeWords, text_or(body, "shape"));
  piece.shape = static_cast<PieceShape>(shape - kShapeWords.begin());
  piece.x_m = body["place"]["x_m"];
  piece.y_m = body["place"]["y_m"];
  piece.z_m = body["place"]["z_m"];
  if (body.contains("direction"))
    for (std::size_t i = 0; i < piece.direction.size(); ++i) piece.direction[i] = body["direction"][i];
  if (body.contains("coefficients"))
    for (std::size_t i = 0; i < kQuadricTerms; ++i) piece.coefficients[i] = body["coefficients"][i];
  piece.mesh = text_or(body, "mesh");
  piece.volume = text_or(body, "volume");
  piece.iso = number_or(body, "iso", 0);
  piece.value_per_m = number_or(body, "value_per_m", 0);
  if (body.contains("carve")) piece.carve = {body["carve"]["force_n"], body["carve"]["value_per_s"]};
  if (body.contains("clay")) {
    const Json& clay = body["clay"];
    piece.clay = {clay["force_n"], clay["sink_m_per_s"], clay["thickness_m"],
                  text_or(clay, "volume") == "kept"};
  }
  for (const auto& [name, value, changes] : kShapeNumbers) piece.*value = number_or(body, name, 0);
  read_wall(piece, body);
  if (body.contains("transient")) {
    const Json& transient = body["transient"];
    piece.transient = {transient["amplitude_n_s_per_m"], transient["frequency_hz"], transient["decay_per_s"]};
  }
  if (body.contains("hand_surface")) {
    piece.hand_surface.emplace();
    for (const auto& [name, value] : kHandSurfaceNumbers)
      (*piece.hand_surface).*value = number_or(body["hand_surface"], name, HandSurface().*value);
  }
  if (body.contains("travel"))
    for (const Json& point : body["travel"]) piece.travel.push_back({point["depth_m"], point["force_n"]});
  if (body.contains("texture")) piece.texture = piece_texture_from(body["texture"]);
  if (body.contains("slide")) {
    piece.slide.emplace();
    for (std::size_t i = 0; i < 3; ++i) piece.slide->direction[i] = body["slide"]["direction"][i];
    for (const auto& [name, value] : kSlideNumbers) (*piece.slide).*value = number_or(body["slide"], name, 0);
  }
  if (body.contains("relief")) {
    piece.relief.emplace();
    piece.relief->file = text_or(body["relief"], "file");
    read_axes(piece.relief->axes, body["relief"]);
    piece.relief->interpolated = text_or(body["relief"], "normals") == "interpolated";
  }
  return piece;
}

Json piece_body(const Piece& piece) {
  Json body = {{"name", piece.name}, {"shape", to_string(piece.shape)}};
  body["place"] = {{"x_m", piece.x_m}, {"y_m", piece.y_m}, {"z_m", piece.z_m}};
  if (piece.shape == PieceShape::plane || piece.shape == PieceShape::cylinder)
    body["direction"] = piece.direction;
  if (piece.shape == PieceShape::quadric) body["coefficients"] = piece.coefficients;
  if (piece.shape == PieceShape::mesh) body["mesh"] = piece.mesh;
  if (piece.shape == PieceShape::volume)
    body["volume"] = piece.volume, body["iso"] = piece.iso, body["value_per_m"] = piece.value_per_m;
  if (piece.carve)
    body["carve"] = {{"force_n", piece.carve->force_n}, {"value_per_s", piece.carve->value_per_s}};
  for (const auto& [name, value, changes] : kShapeNumbers)
    if (piece.*value != 0) body[name] = piece.*value;
  write_wall(piece, body);
  if (piece.transient)
    body["transient"] = {{"amplitude_n_s_per_m", piece.transient->amplitude_n_s_per_m},
                         {"frequency_hz", piece.transient->frequency_hz},
                         {"decay_per_s", piece.transient->decay_per_s}};
  if (piece.hand_surface)
    for (const auto& [name, value] : kHandSurfaceNumbers)
      body["hand_surface"][name] = (*piece.hand_surface).*value;
  for (const TravelPoint& point : piece.travel)
    body["travel"].push_back({{"depth_m", point.depth_m}, {"force_n", point.force_n}});
  if (piece.texture) body["texture"] = piece_texture_body(*piece.texture);
  if (piece.slide) {
    body["slide"]["direction"] = piece.slide->direction;
    for (const auto& [name, value] : kSlideNumbers) body["slide"][name] = (*piece.slide).*value;
    if (!(piece.slide->detent_n > 0)) body["slide"].erase("detent_n"), body["slide"].erase("detent_m");
  }
  if (piece.relief)
    body["relief"] = {{"file", piece.relief->file},
                      {"axes", piece.relief->axes},
                      {"normals", piece.relief->interpolated ? "interpolated" : "exact"}};
  if (piece.clay)
    body["clay"] = {{"force_n", piece.clay->force_n},
                    {"sink_m_per_s", piece.clay->sink_m_per_s},
                    {"thickness_m", piece.clay->thickness_m},
                    {"volume", piece.clay->kept ? "kept" : "lost"}};
  return body;
}

PieceContact contact_from(const Json& scene_body) {
  return text_or(scene_body, "contact") == "add" ? PieceContact::add : PieceContact::ghost;
}

}  // namespace tacto::schema
