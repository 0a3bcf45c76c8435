# SPDX-License-Identifier: GPL-3.0-or-later
# Writes a C++ source with the contents of text files by name, so that the command needs no separate files.
# Arguments: OUTPUT and FILES (a list).
set(entries "")
foreach(path IN LISTS FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} text)
  string(APPEND entries "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by cmake/EmbedFiles.cmake.
#include \"data-schema/files/embedded_files.hpp\"

namespace tacto::schema {
namespace {
constexpr EmbeddedFile kFiles[] = {
${entries}};
}  // namespace
std::span<const EmbeddedFile> embedded_files() { return kFiles; }
}  // namespace tacto::schema
")
