// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>

#include "data-schema/base/module.hpp"
#include "data-schema/exchange/assimp/assimp_functions.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

std::string lower_ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

Result<std::string> mesh_content_of(const std::string& path) {
  TACTO_TRY(check_readable(path));
  std::error_code failed;
  const auto bytes = std::filesystem::file_size(path, failed);
  if (failed || bytes > kMostMeshFileBytes)
    return fail(ErrorKind::unsuitable, fmt::format("it has {} bytes", bytes), path,
                fmt::format("at most {} are read; decimate the mesh", kMostMeshFileBytes));
  std::string content(bytes, '\0');
  std::ifstream stream(path, std::ios::binary);
  if (!stream.read(content.data(), static_cast<std::streamsize>(bytes)))
    return fail(ErrorKind::malformed, "cannot be read to its end", path);
  return content;
}

Mesh mesh_of(const aiScene& scene, double unit_m) {
  Mesh mesh;
  for (const aiMesh* const part : std::span(scene.mMeshes, scene.mNumMeshes)) {
    const std::size_t first = mesh.vertices_m.size();
    for (const aiVector3D& v : std::span(part->mVertices, part->mNumVertices))
      mesh.vertices_m.push_back({unit_m * double{v.x}, unit_m * double{v.y}, unit_m * double{v.z}});
    for (const aiFace& face : std::span(part->mFaces, part->mNumFaces)) {
      if (face.mNumIndices != 3) continue;
      MeshTriangle triangle;
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = static_cast<std::uint32_t>(first + face.mIndices[i]);
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

}  // namespace

bool is_mesh_file(const std::string& path) {
  const std::string ending = lower_ending_of(path);
  return ending == ".stl" || ending == ".obj" || ending == ".ply";
}

// From memory the library opens no other file, such as the materials that an OBJ names.
Result<Mesh> read_mesh_file(const std::string& path, double unit_m) try {
  static const auto entry = function_in_module(kAssimpModule, kAssimpEntry);
  TACTO_TRY(entry);
  static const AssimpFunctions* const functions = reinterpret_cast<AssimpEntry>(*entry)();
  const auto content = mesh_content_of(path);
  TACTO_TRY(content);
  const std::unique_ptr<const aiScene, void (*)(const aiScene*)> scene(
      functions->import(content->data(), static_cast<unsigned>(content->size()),
                        aiProcess_Triangulate | aiProcess_PreTransformVertices,
                        lower_ending_of(path).c_str() + 1),
      functions->release);
  if (!scene)
    return fail(ErrorKind::malformed, fmt::format("cannot be read as a mesh: {}", functions->fault()), path,
                "export it again as STL, OBJ or PLY");
  Mesh mesh = mesh_of(*scene, unit_m);
  if (mesh.triangles.empty() || mesh.triangles.size() > kMostTriangles)
    return fail(ErrorKind::unsuitable, fmt::format("it has {} triangles", mesh.triangles.size()), path,
                fmt::format("a mesh has from 1 to {} triangles", kMostTriangles));
  merge_equal_vertices(mesh);
  return mesh;
} catch (const std::exception& fault) {
  return fail(ErrorKind::malformed, fmt::format("cannot be read as a mesh: {}", fault.what()), path,
              "export it again as STL, OBJ or PLY");
}

}  // namespace tacto::schema
