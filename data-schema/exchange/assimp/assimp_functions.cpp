// SPDX-License-Identifier: GPL-3.0-or-later
// The module tactograph-assimp.so.
#include "data-schema/exchange/assimp/assimp_functions.hpp"

extern "C" __attribute__((visibility("default"))) const tacto::schema::AssimpFunctions*
tacto_assimp_functions() {
  static constexpr tacto::schema::AssimpFunctions kFunctions = {aiImportFileFromMemory, aiReleaseImport,
                                                                aiGetErrorString};
  return &kFunctions;
}
