// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/piece_json.hpp"

#include <algorithm>
#include <array>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<std::string_view, 5> kShapeWords = {"plane", "sphere", "cylinder", "quadric", "mesh"};

// The numbers with a default of 0: they are written if they are something else.
struct PieceNumber {
  const char* name;
  double Piece::*value;
};
constexpr PieceNumber kPieceNumbers[] = {{"thickness_m", &Piece::thickness_m},
                                         {"radius_m", &Piece::radius_m},
                                         {"damping_n_s_per_m", &Piece::damping_n_s_per_m},
                                         {"arrest_mass_kg", &Piece::arrest_mass_kg},
                                         {"integral_n_per_m_s", &Piece::integral_n_per_m_s},
                                         {"integral_bound_n", &Piece::integral_bound_n},
                                         {"integral_leak_per_s", &Piece::integral_leak_per_s}};

}  // namespace

std::string_view to_string(PieceShape shape) {
  return kShapeWords[static_cast<std::size_t>(shape)];
}

std::string_view to_string(PieceContact contact) {
  return contact == PieceContact::add ? "add" : "ghost";
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
  piece.stiffness_n_per_m = body["stiffness_n_per_m"];
  for (const auto& [name, value] : kPieceNumbers) piece.*value = number_or(body, name, 0);
  return piece;
}

Json piece_body(const Piece& piece) {
  Json body = {{"name", piece.name}, {"shape", to_string(piece.shape)}};
  body["place"] = {{"x_m", piece.x_m}, {"y_m", piece.y_m}, {"z_m", piece.z_m}};
  if (piece.shape == PieceShape::plane || piece.shape == PieceShape::cylinder)
    body["direction"] = piece.direction;
  if (piece.shape == PieceShape::quadric) body["coefficients"] = piece.coefficients;
  if (piece.shape == PieceShape::mesh) body["mesh"] = piece.mesh;
  body["stiffness_n_per_m"] = piece.stiffness_n_per_m;
  for (const auto& [name, value] : kPieceNumbers)
    if (piece.*value != 0) body[name] = piece.*value;
  return body;
}

PieceContact contact_from(const Json& scene_body) {
  return text_or(scene_body, "contact") == "add" ? PieceContact::add : PieceContact::ghost;
}

}  // namespace tacto::schema
