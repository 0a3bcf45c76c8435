// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

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

bool write_all(int to, const void* from, std::size_t bytes) {
  const auto* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t written = ::write(to, at, bytes);
    if (written <= 0) return false;
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

// Up to the end, or to a read that fails.
std::string read_all(int from) {
  std::string all;
  std::vector<char> block(1 << 16);
  for (ssize_t got = 0; (got = ::read(from, block.data(), block.size())) > 0;)
    all.append(block.data(), static_cast<std::size_t>(got));
  return all;
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

// What a process of its own sends: the numbers of vertices and triangles, then them; or 0, 0 and why not.
struct SentHead {
  std::uint64_t vertices = 0, triangles = 0;
};

Result<Mesh> mesh_sent(const std::string& sent, const std::string& path) {
  constexpr const char* kRemedy = "export it again as STL, OBJ or PLY";
  SentHead head;
  if (sent.size() < sizeof head)
    return fail(ErrorKind::malformed,
                "cannot be read as a mesh: its contents are not what its beginning says", path, kRemedy);
  std::memcpy(&head, sent.data(), sizeof head);
  if (head.vertices == 0)
    return fail(ErrorKind::malformed, "cannot be read as a mesh: " + sent.substr(sizeof head), path, kRemedy);
  Mesh mesh;
  mesh.vertices_m.resize(head.vertices);
  mesh.triangles.resize(head.triangles);
  const std::size_t of_vertices = head.vertices * sizeof(MeshVertex),
                    of_triangles = head.triangles * sizeof(MeshTriangle);
  if (sent.size() != sizeof head + of_vertices + of_triangles)
    return fail(ErrorKind::malformed, "cannot be read to its end", path, kRemedy);
  std::memcpy(mesh.vertices_m.data(), sent.data() + sizeof head, of_vertices);
  std::memcpy(mesh.triangles.data(), sent.data() + sizeof head + of_vertices, of_triangles);
  return mesh;
}

}  // namespace

bool is_mesh_file(const std::string& path) {
  const std::string ending = lower_ending_of(path);
  return ending == ".stl" || ending == ".obj" || ending == ".ply";
}

// From memory the library opens no other file, such as the materials that an OBJ names. It runs in a process
// of its own, with a limit of time: of some PLY files that were cut it does not return, or ends the process.
Result<Mesh> read_mesh_file(const std::string& path, double unit_m) try {
  static const auto entry = function_in_module(kAssimpModule, kAssimpEntry);
  TACTO_TRY(entry);
  static const AssimpFunctions* const functions = reinterpret_cast<AssimpEntry>(*entry)();
  const auto content = mesh_content_of(path);
  TACTO_TRY(content);
  if (content->empty())
    return fail(ErrorKind::malformed, "is empty", path, "export it again as STL, OBJ or PLY");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return fail(ErrorKind::unsuitable, "cannot start a process to read it", path);
  const pid_t reader = ::fork();
  if (reader == 0) {
    constexpr rlim_t kLeast_s = 5, kBytesPerS = 1'000'000;
    const rlim_t most_s = kLeast_s + content->size() / kBytesPerS;
    const rlimit time{most_s, most_s}, no_core{0, 0};
    ::setrlimit(RLIMIT_CPU, &time);
    ::setrlimit(RLIMIT_CORE, &no_core);
    const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
    const aiScene* const scene = functions->import(content->data(), static_cast<unsigned>(content->size()),
                                                   aiProcess_Triangulate | aiProcess_PreTransformVertices,
                                                   lower_ending_of(path).c_str() + 1);
    const Mesh mesh = scene != nullptr ? mesh_of(*scene, unit_m) : Mesh();
    const SentHead head{mesh.vertices_m.size(), mesh.triangles.size()};
    const std::string fault = scene == nullptr ? functions->fault() : "it has no vertices";
    const bool sent =
        write_all(ends[1], &head, sizeof head) &&
        (head.vertices == 0
             ? write_all(ends[1], fault.data(), fault.size())
             : write_all(ends[1], mesh.vertices_m.data(), head.vertices * sizeof(MeshVertex)) &&
                   write_all(ends[1], mesh.triangles.data(), head.triangles * sizeof(MeshTriangle)));
    ::_exit(sent ? 0 : 1);
  }
  ::close(ends[1]);
  const std::string sent = reader > 0 ? read_all(ends[0]) : std::string();
  ::close(ends[0]);
  int status = 0;
  if (reader > 0) ::waitpid(reader, &status, 0);
  auto read = mesh_sent(status == 0 ? sent : std::string(), path);
  TACTO_TRY(read);
  Mesh mesh = std::move(*read);
  for (const MeshVertex& place : mesh.vertices_m)
    for (const double place_m : place)
      if (!std::isfinite(place_m))
        return fail(ErrorKind::malformed, "a vertex has a place that is not a number", path,
                    "export it again");
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
