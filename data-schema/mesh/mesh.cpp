// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/mesh/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "data-schema/base/format_version.hpp"
#include "data-schema/base/sha256.hpp"
#include "data-schema/spectrogram/netcdf_file.hpp"

namespace tacto::schema {
namespace {

constexpr const char* kMeshKind = "mesh";
constexpr std::string_view kMeshEnding = ".mesh.nc";
constexpr std::size_t kMeshBlock = 1 << 14;  // vertices and triangles of a block in the file
constexpr const char* kMeshRemedy =
    "'tactograph import FILE --unit UNIT --repair' drops triangles that are there twice or have no area, and "
    "turns flipped ones";

MeshVertex way_between(const MeshVertex& a, const MeshVertex& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
MeshVertex cross_product(const MeshVertex& a, const MeshVertex& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot_product(const MeshVertex& a, const MeshVertex& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double longest_edge_m2(const Mesh& mesh, const MeshTriangle& t) {
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const MeshVertex edge = way_between(mesh.vertices_m[t[(i + 1) % 3]], mesh.vertices_m[t[i]]);
    longest = std::max(longest, dot_product(edge, edge));
  }
  return longest;
}

// Its height over the longest edge is rounding.
bool is_degenerate(const Mesh& mesh, const MeshTriangle& t) {
  constexpr double kLeastHeight = 1e-12;  // of the longest edge
  const MeshVertex area = cross_product(way_between(mesh.vertices_m[t[1]], mesh.vertices_m[t[0]]),
                                        way_between(mesh.vertices_m[t[2]], mesh.vertices_m[t[0]]));
  return !(std::sqrt(dot_product(area, area)) > kLeastHeight * longest_edge_m2(mesh, t));
}

// A side of a triangle: between two vertices, along the triangle or against it.
struct Side {
  std::uint32_t low = 0, high = 0, triangle = 0;
  bool forward = true;

  bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
};

// Of triangles of the same three vertices, all but the first.
std::vector<bool> doubled_triangles(const Mesh& mesh) {
  std::vector<std::pair<MeshTriangle, std::uint32_t>> sorted;
  sorted.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    sorted.emplace_back(mesh.triangles[i], i);
    std::ranges::sort(sorted.back().first);
  }
  std::ranges::sort(sorted);
  std::vector<bool> doubled(mesh.triangles.size());
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first) doubled[sorted[i].second] = true;
  return doubled;
}

// Sides of one edge follow each other.
std::vector<Side> sides_of(const Mesh& mesh, const std::vector<bool>& doubled) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (doubled[i] || is_degenerate(mesh, mesh.triangles[i])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[i][k], to = mesh.triangles[i][(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), i, from < to});
    }
  }
  std::ranges::sort(sides, {},
                    [](const Side& side) { return std::tuple(side.low, side.high, side.triangle); });
  return sides;
}

template <class Visit>
void each_edge(const std::vector<Side>& sides, Visit&& visit) {
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t last = first + 1;
    while (last < sides.size() && sides[first].same_edge(sides[last])) ++last;
    visit(std::span(sides).subspan(first, last - first));
    first = last;
  }
}

double volume_of(const Mesh& mesh, const MeshVertex& middle, const MeshTriangle& t) {
  return dot_product(way_between(mesh.vertices_m[t[0]], middle),
                     cross_product(way_between(mesh.vertices_m[t[1]], middle),
                                   way_between(mesh.vertices_m[t[2]], middle))) /
         6;
}

// Which triangles have to be turned so that all that are connected by edges of two go the same way: of each
// connected part the fewer ones.
struct Turns {
  std::vector<bool> turned;
  std::size_t flipped = 0;
  bool one_sided = false;
  std::vector<std::vector<std::uint32_t>> parts;  // their triangles
};

Turns turns_of(const Mesh& mesh, const std::vector<Side>& sides) {
  struct Neighbour {
    std::uint32_t triangle;
    bool same;
  };
  const std::size_t count = mesh.triangles.size();
  std::vector<std::vector<Neighbour>> neighbours(count);
  each_edge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 2) return;
    const bool same = edge[0].forward != edge[1].forward;
    neighbours[edge[0].triangle].push_back({edge[1].triangle, same});
    neighbours[edge[1].triangle].push_back({edge[0].triangle, same});
  });
  Turns turns{std::vector<bool>(count), 0, false, {}};
  std::vector<bool> seen(count);
  for (std::uint32_t start = 0; start < count; ++start) {
    if (seen[start]) continue;
    std::vector<std::uint32_t> part{start};
    seen[start] = true;
    std::size_t flipped = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t own = part[i];
      flipped += turns.turned[own] ? 1 : 0;
      for (const auto& [other, same] : neighbours[own]) {
        const bool turned = same == turns.turned[own];
        if (seen[other]) {
          turns.one_sided = turns.one_sided || turns.turned[other] != turned;
          continue;
        }
        seen[other] = true;
        turns.turned[other] = turned;
        part.push_back(other);
      }
    }
    turns.flipped += std::min(flipped, part.size() - flipped);
    if (2 * flipped > part.size())
      for (const std::uint32_t own : part) turns.turned[own] = !turns.turned[own];
    turns.parts.push_back(std::move(part));
  }
  return turns;
}

// Moeller and Trumbore 1997.
bool crosses(const Mesh& mesh, const MeshTriangle& t, const MeshVertex& from, const MeshVertex& way) {
  const MeshVertex& corner = mesh.vertices_m[t[0]];
  const MeshVertex one = way_between(mesh.vertices_m[t[1]], corner),
                   other = way_between(mesh.vertices_m[t[2]], corner), across = cross_product(way, other),
                   back = way_between(from, corner), around = cross_product(back, one);
  const double area = dot_product(one, across);
  if (area == 0) return false;
  const double u = dot_product(back, across) / area, v = dot_product(way, around) / area;
  return u >= 0 && v >= 0 && u + v <= 1 && dot_product(other, around) / area > 0;
}

// A connected part of a closed mesh, whose triangles go the same way.
struct Part {
  const std::vector<std::uint32_t>* triangles = nullptr;
  MeshVertex least_m, most_m;
  double volume_m3 = 0;
};

Part part_of(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  Part part{&triangles, {}, {}, 0};
  part.least_m = part.most_m = mesh.vertices_m[mesh.triangles[triangles[0]][0]];
  const MeshVertex middle = part.least_m;
  for (const std::uint32_t triangle : triangles) {
    part.volume_m3 += volume_of(mesh, middle, mesh.triangles[triangle]);
    for (const std::uint32_t vertex : mesh.triangles[triangle])
      for (std::size_t i = 0; i < 3; ++i) {
        part.least_m[i] = std::min(part.least_m[i], mesh.vertices_m[vertex][i]);
        part.most_m[i] = std::max(part.most_m[i], mesh.vertices_m[vertex][i]);
      }
  }
  return part;
}

// By some of its vertices: parts that overlap are not one within the other.
bool is_within(const Mesh& mesh, const Part& part, const Part& around) {
  constexpr std::size_t kTried = 16;
  constexpr MeshVertex kWay = {0.5257, 0.8506, 0.0123};  // along no usual face or edge
  for (std::size_t i = 0; i < 3; ++i)
    if (part.least_m[i] < around.least_m[i] || part.most_m[i] > around.most_m[i]) return false;
  const std::size_t step = part.triangles->size() / kTried + 1;
  for (std::size_t i = 0; i < part.triangles->size(); i += step) {
    const MeshVertex& from = mesh.vertices_m[mesh.triangles[(*part.triangles)[i]][0]];
    if (std::ranges::count_if(
            *around.triangles,
            [&](std::uint32_t triangle) { return crosses(mesh, mesh.triangles[triangle], from, kWay); }) %
            2 ==
        0)
      return false;
  }
  return true;
}

// The parts whose volume has the wrong sign: it is positive, but negative of a cavity, which is within an odd
// number of others.
std::vector<const std::vector<std::uint32_t>*> parts_inside_out(const Mesh& mesh, const Turns& turns) {
  std::vector<Part> parts;
  for (const auto& triangles : turns.parts) parts.push_back(part_of(mesh, triangles));
  std::vector<const std::vector<std::uint32_t>*> wrong;
  for (const Part& part : parts) {
    const auto around = std::ranges::count_if(
        parts, [&](const Part& other) { return &other != &part && is_within(mesh, part, other); });
    if (part.volume_m3 != 0 && (part.volume_m3 < 0) != (around % 2 != 0)) wrong.push_back(part.triangles);
  }
  return wrong;
}

// Moves the triangles to the vertices that `kept` names, and leaves out the vertices that no triangle has.
void renumber(Mesh& mesh, const std::vector<std::uint32_t>& kept) {
  constexpr std::uint32_t kUnused = 0xFFFFFFFF;
  std::vector<std::uint32_t> place(mesh.vertices_m.size(), kUnused);
  std::vector<MeshVertex> vertices;
  for (MeshTriangle& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) {
      std::uint32_t& at = place[kept[vertex]];
      if (at == kUnused) {
        at = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(mesh.vertices_m[kept[vertex]]);
      }
      vertex = at;
    }
  mesh.vertices_m = std::move(vertices);
}

// In the order of their places along x, each vertex joins the first one that is near and has not joined
// another.
std::vector<std::uint32_t> near_vertices(const Mesh& mesh, double merge_m) {
  const auto& at = mesh.vertices_m;
  std::vector<std::uint32_t> order(at.size()), kept(at.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::iota(kept.begin(), kept.end(), std::uint32_t{0});
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::tuple(at[i], i); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (kept[order[i]] != order[i]) continue;
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const MeshVertex way = way_between(at[order[j]], at[order[i]]);
      if (way[0] > merge_m || (merge_m == 0 && at[order[j]] != at[order[i]])) break;
      if (kept[order[j]] == order[j] && dot_product(way, way) <= merge_m * merge_m) kept[order[j]] = order[i];
    }
  }
  return kept;
}

std::string mesh_sum(const Mesh& mesh) {
  Sha256 sum;
  sum.add({reinterpret_cast<const char*>(mesh.vertices_m.data()), std::span(mesh.vertices_m).size_bytes()});
  sum.add({reinterpret_cast<const char*>(mesh.triangles.data()), std::span(mesh.triangles).size_bytes()});
  return sum.hexadecimal();
}

Result<void> write_mesh_netcdf(const std::string& path, const std::string& named, const Mesh& mesh) {
  NetcdfWriter file(path);
  const std::size_t vertices = mesh.vertices_m.size(), triangles = mesh.triangles.size();
  const int of_vertices = file.dimension("vertices", vertices), axes = file.dimension("axes", 3),
            of_triangles = file.dimension("triangles", triangles), corners = file.dimension("corners", 3);
  const int vertex = file.values("vertex", {{of_vertices, axes}, {std::min(vertices, kMeshBlock), 3}}, "m",
                                 "place of a vertex");
  const int triangle =
      file.indices("triangle", {{of_triangles, corners}, {std::min(triangles, kMeshBlock), 3}},
                   "vertices of a triangle, counter-clockwise from outside");
  std::vector<double> numbers;
  for (const MeshVertex& place : mesh.vertices_m) numbers.insert(numbers.end(), place.begin(), place.end());
  file.put(vertex, {{0, 0}, {vertices, 3}}, std::span<const double>(numbers));
  numbers.clear();
  for (const MeshTriangle& t : mesh.triangles)
    for (const std::uint32_t place : t) numbers.push_back(place);
  file.put(triangle, {{0, 0}, {triangles, 3}}, std::span<const double>(numbers));
  file.attribute("Conventions", std::string("CF-1.10"));
  file.attribute("kind", std::string(kMeshKind));
  file.attribute("version", std::string(kFormatVersion));
  file.attribute("sha256", mesh_sum(mesh));
  const std::pair<const char*, const std::string&> texts[] = {
      {"notes", mesh.notes}, {"source", mesh.source}, {"created", mesh.created}, {"creator", mesh.creator}};
  for (const auto& [name, text] : texts)
    if (!text.empty()) file.attribute(name, text);
  return file.close(named);
}

Result<void> read_mesh_numbers(NetcdfReader& file, const std::string& path, Mesh& mesh) {
  const std::size_t vertices = file.length("vertices"), triangles = file.length("triangles");
  if (triangles > kMostTriangles || vertices > 3 * kMostTriangles) return check_mesh(mesh, path);
  const std::vector<double> places = file.values("vertex", {{0, 0}, {vertices, 3}}),
                            corners = file.values("triangle", {{0, 0}, {triangles, 3}});
  TACTO_TRY(file.status(path));
  for (std::size_t i = 0; i < places.size(); i += 3)
    mesh.vertices_m.push_back({places[i], places[i + 1], places[i + 2]});
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    MeshTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const double corner = corners[i + k];
      if (!(corner >= 0 && corner < static_cast<double>(vertices)))
        return fail(ErrorKind::malformed,
                    fmt::format("triangle {} has the vertex {}, it has {} vertices", i / 3, corner, vertices),
                    path);
      t[k] = static_cast<std::uint32_t>(corner);
    }
    mesh.triangles.push_back(t);
  }
  return {};
}

}  // namespace

MeshFaults faults_of(const Mesh& mesh) {
  MeshFaults faults;
  for (const MeshTriangle& triangle : mesh.triangles) faults.degenerate += is_degenerate(mesh, triangle);
  const std::vector<bool> doubled = doubled_triangles(mesh);
  faults.doubled = static_cast<std::size_t>(std::ranges::count(doubled, true));
  const std::vector<Side> sides = sides_of(mesh, doubled);
  bool unequal = false;
  each_edge(sides, [&](std::span<const Side> edge) {
    const auto forward = static_cast<std::size_t>(std::ranges::count(edge, true, &Side::forward));
    (edge.size() == 1 ? faults.open_edges : faults.odd_edges) += edge.size() % 2;
    unequal = unequal || (edge.size() % 2 == 0 && 2 * forward != edge.size());
  });
  const Turns turns = turns_of(mesh, sides);
  faults.flipped = turns.flipped;
  faults.one_sided = turns.one_sided || (unequal && turns.flipped == 0);
  faults.inside_out =
      !unequal && faults.open_edges + faults.odd_edges == 0 && !parts_inside_out(mesh, turns).empty();
  return faults;
}

MeshFigures figures_of(const Mesh& mesh) {
  MeshFigures figures;
  figures.least_m = figures.most_m = mesh.vertices_m.at(mesh.triangles.at(0)[0]);
  const MeshVertex middle = figures.least_m;
  for (const MeshTriangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle)
      for (std::size_t i = 0; i < 3; ++i) {
        const double place_m = mesh.vertices_m[vertex][i];
        figures.least_m[i] = std::min(figures.least_m[i], place_m);
        figures.most_m[i] = std::max(figures.most_m[i], place_m);
      }
    figures.longest_edge_m = std::max(figures.longest_edge_m, longest_edge_m2(mesh, triangle));
    figures.volume_m3 += volume_of(mesh, middle, triangle);
  }
  figures.longest_edge_m = std::sqrt(figures.longest_edge_m);
  return figures;
}

void merge_equal_vertices(Mesh& mesh) {
  renumber(mesh, near_vertices(mesh, 0));
}

MeshRepair repair(Mesh& mesh, double merge_m) {
  MeshRepair repair;
  const std::size_t vertices = mesh.vertices_m.size(), triangles = mesh.triangles.size();
  renumber(mesh, near_vertices(mesh, merge_m));
  repair.merged = vertices - mesh.vertices_m.size();
  const std::vector<bool> doubled = doubled_triangles(mesh);
  std::vector<MeshTriangle> kept;
  for (std::size_t i = 0; i < triangles; ++i)
    if (!doubled[i] && !is_degenerate(mesh, mesh.triangles[i])) kept.push_back(mesh.triangles[i]);
  mesh.triangles = std::move(kept);
  repair.dropped = triangles - mesh.triangles.size();
  Turns turns = turns_of(mesh, sides_of(mesh, std::vector<bool>(mesh.triangles.size())));
  const auto turn = [&](std::size_t i) { std::swap(mesh.triangles[i][1], mesh.triangles[i][2]); };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (turns.turned[i]) turn(i);
  if (faults_of(mesh).inside_out)
    for (const auto* const part : parts_inside_out(mesh, turns))
      for (const std::uint32_t i : *part) {
        turn(i);
        turns.turned[i] = !turns.turned[i];
      }
  repair.turned = static_cast<std::size_t>(std::ranges::count(turns.turned, true));
  return repair;
}

Result<void> check_mesh(const Mesh& mesh, const std::string& where) {
  const auto unsuitable = [&](std::string what, std::string remedy) {
    return fail(ErrorKind::unsuitable, std::move(what), where, std::move(remedy));
  };
  if (mesh.triangles.empty() || mesh.triangles.size() > kMostTriangles)
    return unsuitable(fmt::format("it has {} triangles", mesh.triangles.size()),
                      fmt::format("a mesh has from 1 to {} triangles; decimate it", kMostTriangles));
  for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i)
    for (const double place_m : mesh.vertices_m[i])
      if (!std::isfinite(place_m))
        return unsuitable(fmt::format("the place of vertex {} is not a number", i), "export it again");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i])
      if (vertex >= mesh.vertices_m.size())
        return unsuitable(fmt::format("triangle {} has a vertex that is not there", i), "export it again");
  const MeshFigures figures = figures_of(mesh);
  double size_m = 0;
  for (std::size_t i = 0; i < 3; ++i) size_m = std::max(size_m, figures.most_m[i] - figures.least_m[i]);
  if (size_m > kLargestMesh_m || size_m < kSmallestMesh_m)
    return unsuitable(fmt::format("it is {:.4g} m large", size_m),
                      fmt::format("from {:g} m to {:g} m are possible: is the unit right?", kSmallestMesh_m,
                                  kLargestMesh_m));
  const MeshFaults faults = faults_of(mesh);
  if (faults.degenerate > 0)
    return unsuitable(
        fmt::format("{} of its {} triangles have no area", faults.degenerate, mesh.triangles.size()),
        kMeshRemedy);
  if (faults.doubled > 0)
    return unsuitable(
        fmt::format("{} of its {} triangles are there twice", faults.doubled, mesh.triangles.size()),
        kMeshRemedy);
  if (faults.flipped > 0)
    return unsuitable(fmt::format("{} of its {} triangles are turned the other way than the others",
                                  faults.flipped, mesh.triangles.size()),
                      kMeshRemedy);
  if (faults.one_sided)
    return unsuitable("its triangles have no common outer side",
                      "repair it in a program for meshes: each edge belongs to two triangles");
  if (faults.inside_out)
    return unsuitable("the outer side of a part is inside: its volume is negative", kMeshRemedy);
  return {};
}

std::string mesh_path(const std::string& name) {
  return name.ends_with(kMeshEnding) ? name : name + std::string(kMeshEnding);
}

Result<void> write_mesh(const std::string& path, const Mesh& mesh, Existing existing) {
  TACTO_TRY(check_mesh(mesh, path));
  PendingFiles files;
  const auto temporary = files.add(path);
  TACTO_TRY(temporary);
  TACTO_TRY(write_mesh_netcdf(*temporary, path, mesh));
  return files.commit(existing);
}

Result<Mesh> read_mesh(const std::string& name) {
  const std::string path = mesh_path(name);
  constexpr const char* kMaker = "'tactograph import' makes one from an STL, OBJ or PLY file";
  if (!is_file(path)) return fail(ErrorKind::not_found, "there is no such mesh", path, kMaker);
  NetcdfReader file(path);
  TACTO_TRY(file.status(path));
  if (file.text("kind") != kMeshKind)
    return fail(ErrorKind::malformed, "is netCDF, but not a mesh of tactograph", path, kMaker);
  auto newer = newer_version(file.text("version"), path, path);
  TACTO_TRY(newer);
  Mesh mesh;
  mesh.newer_version = std::move(*newer);
  if (file.has("vertex") && file.units("vertex") != "m")
    return fail(ErrorKind::malformed, fmt::format("its vertices are in '{}', not in m", file.units("vertex")),
                path);
  TACTO_TRY(read_mesh_numbers(file, path, mesh));
  if (const std::string sum = file.text("sha256"); !sum.empty() && sum != mesh_sum(mesh))
    return fail(
        ErrorKind::malformed,
        "its vertices or triangles do not match its checksum (attribute sha256): a number was changed", path,
        "import the mesh again; to keep the change, remove the attribute");
  mesh.notes = file.text("notes"), mesh.source = file.text("source");
  mesh.created = file.text("created"), mesh.creator = file.text("creator");
  TACTO_TRY(file.status(path));
  TACTO_TRY(check_mesh(mesh, path));
  return mesh;
}

bool is_mesh(const std::string& path) {
  return NetcdfReader(path).text("kind") == kMeshKind;
}

}  // namespace tacto::schema
