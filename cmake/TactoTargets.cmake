# SPDX-License-Identifier: GPL-3.0-or-later
# How every target of the house is built: one set of flags, one way to declare a folder's library and its verbs.

add_library(tacto_options INTERFACE)
target_compile_features(tacto_options INTERFACE cxx_std_20)
target_include_directories(tacto_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(tacto_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # gcc 12 warns falsely about std::string (bug 105651)
  # One result on every machine: a fused multiply-add would round differently where the processor has one.
  -ffp-contract=off)
if(CMAKE_UNITY_BUILD)  # gcc takes the files of a unity for headers, and warns of what they keep to themselves
  target_compile_options(tacto_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
if(TACTO_SANITIZE)
  target_compile_options(tacto_options INTERFACE -fsanitize=${TACTO_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  target_link_options(tacto_options INTERFACE -fsanitize=${TACTO_SANITIZE})
endif()

# All verbs end in one library: the command's table and the tests of the table link the same code.
add_library(tacto_verbs INTERFACE)

# tacto_sources(VARIABLE FOLDER...) : the sources right in those folders, for every room the same way.
function(tacto_sources variable)
  list(TRANSFORM ARGN APPEND /*.cpp OUTPUT_VARIABLE patterns)
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# tacto_library(NAME sources... ) : a folder's library.
function(tacto_library name)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PUBLIC tacto_options)
endfunction()

# tacto_compile_quickly(NAME header): for code that waits for people or files, and includes one huge header: that header
# once, and little optimisation. Halves the time of a build.
function(tacto_compile_quickly name header)
  target_precompile_headers(${name} PRIVATE ${header})
  target_compile_options(${name} PRIVATE -O1)
endfunction()

# tacto_cli(NAME sources...) : a folder's verbs, linked into the command.
function(tacto_cli name)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PUBLIC tacto_options tacto_command_line)
  target_precompile_headers(${name} REUSE_FROM tacto_command_line)
  target_compile_options(${name} PRIVATE -O1)
  target_link_libraries(tacto_verbs INTERFACE ${name})
endfunction()
