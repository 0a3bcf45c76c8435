// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the library assimp that tactograph calls. assimp reads 40 formats and depends on libraries
// of compression; so it is linked to a module, which is loaded at its first use.
#pragma once

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

namespace tacto::schema {

struct AssimpFunctions {
  decltype(&::aiImportFileFromMemory) import;
  decltype(&::aiReleaseImport) release;
  decltype(&::aiGetErrorString) fault;
};

inline constexpr const char* kAssimpModule = "tactograph-assimp.so";
inline constexpr const char* kAssimpEntry = "tacto_assimp_functions";
using AssimpEntry = const AssimpFunctions* (*)();

}  // namespace tacto::schema
