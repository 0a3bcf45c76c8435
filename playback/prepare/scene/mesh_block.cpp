// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/mesh_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>

#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::playback {
namespace {

constexpr std::size_t kLeafTriangles = 4;
static_assert(kLeafTriangles <= core::kMostLeafTriangles);
constexpr float kSkin = 0x1p-18F;  // of the half extent

using MeshPlace = std::array<float, 3>;

struct MeshBox {
  MeshPlace least = {INFINITY, INFINITY, INFINITY}, most = {-INFINITY, -INFINITY, -INFINITY};

  void add(const MeshPlace& place) {
    for (std::size_t i = 0; i < 3; ++i)
      least[i] = std::min(least[i], place[i]), most[i] = std::max(most[i], place[i]);
  }
  std::size_t longest() const {
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (most[i] - least[i] > most[axis] - least[axis]) axis = i;
    return axis;
  }
};

class MeshTree {
 public:
  MeshTree(const std::vector<MeshPlace>& vertices, const std::vector<schema::MeshTriangle>& triangles,
           float skin_m)
      : vertices_(vertices), triangles_(triangles), skin_m_(skin_m), order_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    for (const schema::MeshTriangle& triangle : triangles) {
      MeshBox box;
      for (const std::uint32_t vertex : triangle) box.add(vertices[vertex]);
      middles_.push_back(
          {box.least[0] + box.most[0], box.least[1] + box.most[1], box.least[2] + box.most[2]});
    }
    divide(0, order_.size());
  }
  const std::vector<core::MeshNode>& nodes() const { return nodes_; }
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  // As deep as the logarithm of the number of triangles.
  void divide(std::size_t first, std::size_t last) {
    const std::size_t place = nodes_.size();
    nodes_.emplace_back();
    const std::span<std::uint32_t> own = std::span(order_).subspan(first, last - first);
    MeshBox box, middles;
    for (const std::uint32_t triangle : own) {
      for (const std::uint32_t vertex : triangles_[triangle]) box.add(vertices_[vertex]);
      middles.add(middles_[triangle]);
    }
    core::MeshNode node;
    for (std::size_t i = 0; i < 3; ++i)
      node.least_m[i] = box.least[i] - skin_m_, node.most_m[i] = box.most[i] + skin_m_;
    if (own.size() <= kLeafTriangles) {
      node.leaf = static_cast<std::uint32_t>(first * (core::kMostLeafTriangles + 1) + own.size());
    } else {
      const std::size_t half = own.size() / 2, axis = middles.longest();
      std::ranges::nth_element(own, own.begin() + static_cast<std::ptrdiff_t>(half), [&](auto a, auto b) {
        const float left = middles_[a][axis], right = middles_[b][axis];
        return left < right || (left == right && a < b);
      });
      divide(first, first + half);
      divide(first + half, last);
    }
    node.skip = static_cast<std::uint32_t>(nodes_.size());
    nodes_[place] = node;
  }

  const std::vector<MeshPlace>& vertices_;
  const std::vector<schema::MeshTriangle>& triangles_;
  float skin_m_;
  std::vector<std::uint32_t> order_;
  std::vector<MeshPlace> middles_;
  std::vector<core::MeshNode> nodes_;
};

bool has_area(const std::vector<MeshPlace>& vertices, const schema::MeshTriangle& triangle) {
  std::array<std::array<double, 3>, 2> edge;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < 3; ++i)
      edge[k][i] = double{vertices[triangle[k + 1]][i]} - double{vertices[triangle[0]][i]};
  const auto& [a, b] = edge;
  return a[1] * b[2] != a[2] * b[1] || a[2] * b[0] != a[0] * b[2] || a[0] * b[1] != a[1] * b[0];
}

template <class T>
void append_parts(std::vector<std::uint32_t>& words, const T* parts, std::size_t count) {
  static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
  const std::size_t before = words.size();
  words.resize(before + count * sizeof(T) / sizeof(std::uint32_t));
  std::memcpy(words.data() + before, parts, count * sizeof(T));
}

}  // namespace

schema::MeshVertex middle_of(const schema::Mesh& mesh) {
  const schema::MeshFigures figures = figures_of(mesh);
  schema::MeshVertex middle;
  for (std::size_t i = 0; i < 3; ++i) middle[i] = (figures.least_m[i] + figures.most_m[i]) / 2;
  return middle;
}

std::vector<std::uint32_t> mesh_table(const schema::Mesh& mesh, const schema::MeshVertex& shift_m) {
  std::vector<MeshPlace> vertices;
  vertices.reserve(mesh.vertices_m.size());
  float half_m = 0;
  for (const schema::MeshVertex& vertex : mesh.vertices_m) {
    MeshPlace place;
    for (std::size_t i = 0; i < 3; ++i) {
      place[i] = static_cast<float>(vertex[i] + shift_m[i]);
      half_m = std::max(half_m, std::abs(place[i]));
    }
    vertices.push_back(place);
  }
  std::vector<schema::MeshTriangle> triangles;
  for (const schema::MeshTriangle& triangle : mesh.triangles)
    if (has_area(vertices, triangle)) triangles.push_back(triangle);
  core::MeshTable table;
  table.piece.form[core::kPieceDirection + 2] = 1;
  table.piece.form[core::kPieceSize] = half_m;
  table.skin_m = kSkin * half_m;
  const MeshTree tree(vertices, triangles, table.skin_m);
  table.nodes = static_cast<std::uint32_t>(tree.nodes().size());
  table.triangles = static_cast<std::uint32_t>(triangles.size());
  table.vertices = static_cast<std::uint32_t>(vertices.size());
  std::vector<std::uint32_t> words;
  append_parts(words, &table, 1);
  append_parts(words, tree.nodes().data(), tree.nodes().size());
  for (const std::uint32_t triangle : tree.order()) append_parts(words, triangles[triangle].data(), 3);
  append_parts(words, vertices.data(), vertices.size());
  return words;
}

}  // namespace tacto::playback
