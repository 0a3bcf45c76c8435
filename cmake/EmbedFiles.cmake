# SPDX-License-Identifier: GPL-3.0-or-later
# Writes a C++ source with the contents of files by name, so that the command needs no separate files. Arguments: OUTPUT,
# NAMESPACE and FUNCTION (tacto::NAMESPACE::FUNCTION() returns them), and FILES (a list).
set(arrays "")
set(entries "")
set(number 0)
foreach(path IN LISTS FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} digits HEX)
  string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${digits}")
  string(APPEND arrays "constexpr char kFile${number}[] = \"${bytes}\";\n")
  string(APPEND entries "    {\"${name}\", {kFile${number}, sizeof kFile${number} - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()
set(result "{}")
if(number GREATER 0)
  string(APPEND arrays "constexpr schema::EmbeddedFile kFiles[] = {\n${entries}};\n")
  set(result "kFiles")
endif()
file(WRITE ${OUTPUT} "// Made by cmake/EmbedFiles.cmake.
#include \"data-schema/files/embedded_files.hpp\"

namespace tacto::${NAMESPACE} {
std::span<const schema::EmbeddedFile> ${FUNCTION}();
${arrays}std::span<const schema::EmbeddedFile> ${FUNCTION}() { return ${result}; }
}  // namespace tacto::${NAMESPACE}
")
