# SPDX-License-Identifier: GPL-3.0-or-later
# Common settings of all targets: flags, and functions that declare a folder's library and its verbs.

add_library(tacto_options INTERFACE)
target_compile_features(tacto_options INTERFACE cxx_std_20)
target_include_directories(tacto_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(tacto_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # gcc 12 warns falsely about std::string (bug 105651)
  # The same bits on every machine: processors with a fused multiply-add would round differently.
  -ffp-contract=off)
if(CMAKE_UNITY_BUILD)  # gcc treats the files of a unity build as headers and warns of their anonymous namespaces
  target_compile_options(tacto_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
if(TACTO_SANITIZE)
  target_compile_options(tacto_options INTERFACE -fsanitize=${TACTO_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  target_link_options(tacto_options INTERFACE -fsanitize=${TACTO_SANITIZE})
endif()

# One library links all verbs, for the command and for the tests of its table of verbs.
add_library(tacto_verbs INTERFACE)

# tacto_sources(VARIABLE FOLDER...): lists the sources directly in these folders.
function(tacto_sources variable)
  list(TRANSFORM ARGN APPEND /*.cpp OUTPUT_VARIABLE patterns)
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# tacto_library(NAME sources...): declares a folder's library.
function(tacto_library name)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PUBLIC tacto_options)
endfunction()

# tacto_module(NAME FOR sources...): what the library FOR loads when it first needs it (data-schema/base/module.hpp), so
# that a command does not wait for libraries that it does not use. Programs find it by their RUNPATH.
set(TACTO_MODULES lib/tactograph)
set(CMAKE_BUILD_RPATH ${CMAKE_BINARY_DIR}/${TACTO_MODULES})
set(CMAKE_INSTALL_RPATH $ORIGIN/../${TACTO_MODULES})
# Program and modules name their build, because a module of another build would be called wrongly: another order of
# functions, other types.
file(GLOB shared CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/data-schema/base/*.hpp
     ${CMAKE_SOURCE_DIR}/data-schema/netcdf/* ${CMAKE_SOURCE_DIR}/data-schema/exchange/matio/*
     ${CMAKE_SOURCE_DIR}/spatial/picture/draw/*.hpp ${CMAKE_SOURCE_DIR}/spatial/picture/engine/*
     ${CMAKE_SOURCE_DIR}/analysis/live/server/*)
set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${shared})
foreach(file IN LISTS shared)
  file(SHA256 ${CMAKE_SOURCE_DIR}/${file} sum)
  string(APPEND sums "${file} ${sum}\n")
endforeach()
string(SHA256 sums "${sums}")
string(SUBSTRING ${sums} 0 12 TACTO_MODULE_SUM)
set(TACTO_MODULE_BUILD ${CMAKE_BINARY_DIR}/generated/module_build.cpp)
configure_file(${CMAKE_SOURCE_DIR}/cmake/module_build.cpp.in ${TACTO_MODULE_BUILD} @ONLY)
set_source_files_properties(${TACTO_MODULE_BUILD} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

function(tacto_module name for)
  add_library(${name} MODULE ${ARGN} ${TACTO_MODULE_BUILD})
  target_link_libraries(${name} PRIVATE tacto_options)
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden BUILD_RPATH "" INSTALL_RPATH ""
                        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${TACTO_MODULES})
  add_dependencies(${for} ${name})
  install(TARGETS ${name} LIBRARY DESTINATION ${TACTO_MODULES} COMPONENT tactograph)
endfunction()

# tacto_compile_quickly(NAME header): for code that is not time-critical and includes one large header. The header is
# precompiled and optimisation is low, which halves the build time.
function(tacto_compile_quickly name header)
  target_precompile_headers(${name} PRIVATE ${header})
  target_compile_options(${name} PRIVATE -O1)
endfunction()

# tacto_embed(VARIABLE NAMESPACE FUNCTION file...): a source that contains these files (EmbedFiles.cmake).
function(tacto_embed variable namespace function)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  add_custom_command(
    OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${source} -D NAMESPACE=${namespace} -D FUNCTION=${function} -D "FILES=${ARGN}"
            -P ${CMAKE_SOURCE_DIR}/cmake/EmbedFiles.cmake
    DEPENDS ${ARGN} ${CMAKE_SOURCE_DIR}/cmake/EmbedFiles.cmake VERBATIM)
  set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS -Wno-overlength-strings)
  set(${variable} ${source} PARENT_SCOPE)
endfunction()

# tacto_cli(NAME sources...): declares a folder's verbs and links them into the command.
function(tacto_cli name)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PUBLIC tacto_options tacto_command_line)
  target_precompile_headers(${name} REUSE_FROM tacto_command_line)
  target_compile_options(${name} PRIVATE -O1)
  target_link_libraries(tacto_verbs INTERFACE ${name})
endfunction()
