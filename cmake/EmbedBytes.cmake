# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the C++ source of live_assets(): files of any content, by name. Arguments: OUTPUT and FILES (a list).
set(arrays "")
set(entries "")
set(number 0)
foreach(path IN LISTS FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} digits HEX)
  string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${digits}")
  string(APPEND arrays "constexpr char kAsset${number}[] = \"${bytes}\";\n")
  string(APPEND entries "    {\"${name}\", {kAsset${number}, sizeof kAsset${number} - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()
if(number EQUAL 0)
  set(table "std::span<const LiveAsset> live_assets() { return {}; }\n")
else()
  set(table "constexpr LiveAsset kAssets[] = {\n${entries}};\nstd::span<const LiveAsset> live_assets() { return kAssets; }\n")
endif()
file(WRITE ${OUTPUT} "// Made by cmake/EmbedBytes.cmake.
#include \"analysis/live/live_assets.hpp\"

namespace tacto::analysis {
${arrays}${table}}  // namespace tacto::analysis
")
