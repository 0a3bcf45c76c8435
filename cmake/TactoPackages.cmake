# SPDX-License-Identifier: GPL-3.0-or-later
# Debian packages from the install tree: tactograph (commands, manual pages, completion, udev rules, systemd unit),
# tactograph-dev (the Apache-licensed core and schemas), python3-tactograph. `./bootstrap package` makes them.

# The program generates manual pages and completion from its table of verbs, and pages from the help of the others.
install(CODE [[
  set(share "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share")
  file(MAKE_DIRECTORY "${share}/bash-completion/completions")]] COMPONENT tactograph)
install(CODE "set(program \"$<TARGET_FILE:tactograph>\")
              set(others \"$<TARGET_FILE:tactographd>;$<TARGET_FILE:tactograph_gadget>\")" COMPONENT tactograph)
install(CODE [[
  execute_process(COMMAND "${program}" man-pages "${share}/man" ${others} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND "${program}" completion OUTPUT_FILE "${share}/bash-completion/completions/tactograph"
                  COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB pages "${share}/man/man?/tactograph*.?")
  execute_process(COMMAND gzip -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)]] COMPONENT tactograph)
file(GLOB presets CONFIGURE_DEPENDS data-schema/presets/*.json)
install(FILES ${presets} DESTINATION share/tactograph/presets COMPONENT tactograph)

# All documents, and what they show or link to, in the folders of the sources, so that their links work.
foreach(folder . analysis capture data-schema firmware-host playback spatial tests)
  set(depth GLOB_RECURSE)
  if(folder STREQUAL .)
    set(depth GLOB)
  endif()
  file(${depth} documents RELATIVE ${CMAKE_SOURCE_DIR} CONFIGURE_DEPENDS ${folder}/*.md)
  foreach(document IN LISTS documents)
    get_filename_component(place ${document} DIRECTORY)
    install(FILES ${document} DESTINATION share/doc/tactograph/${place} COMPONENT tactograph)
  endforeach()
endforeach()
install(FILES firmware-host/rig.svg firmware-host/signals.svg DESTINATION share/doc/tactograph/firmware-host COMPONENT tactograph)
install(DIRECTORY analysis/pictures DESTINATION share/doc/tactograph/analysis COMPONENT tactograph)
install(DIRECTORY data-schema/octave DESTINATION share/doc/tactograph/data-schema COMPONENT tactograph)

file(GLOB schemas CONFIGURE_DEPENDS data-schema/schemas/*.json)
install(FILES ${schemas} DESTINATION share/tactograph/schemas COMPONENT tactograph-dev)
install(DIRECTORY firmware-host/core DESTINATION share/tactograph/src/firmware-host COMPONENT tactograph-dev
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.cpp" PATTERN "*.h" PATTERN "*.md")

install(DIRECTORY data-schema/python/tactograph DESTINATION lib/python3/dist-packages COMPONENT python3-tactograph
        FILES_MATCHING PATTERN "*.py" PATTERN __pycache__ EXCLUDE)
install(FILES data-schema/python/README.md DESTINATION share/doc/python3-tactograph COMPONENT python3-tactograph)

# The documentation that every Debian package contains.
foreach(component tactograph tactograph-dev python3-tactograph)
  install(FILES cmake/debian/copyright DESTINATION share/doc/${component} COMPONENT ${component})
  install(CODE "
    set(document \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/doc/${component}\")
    configure_file(\"${CMAKE_SOURCE_DIR}/CHANGELOG.md\" \"\${document}/changelog\" COPYONLY)
    execute_process(COMMAND gzip -9nf \"\${document}/changelog\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGE_VENDOR tactograph)
set(CPACK_PACKAGE_CONTACT "tactograph developers <tactograph@users.noreply.github.com>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL tactograph tactograph-dev python3-tactograph)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_TACTOGRAPH_PACKAGE_NAME tactograph)
set(CPACK_DEBIAN_TACTOGRAPH_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TACTOGRAPH_PACKAGE_SHLIBDEPS ON)
# shlibdeps finds only libraries. In addition, pictures need a font, and the daemon's account needs adduser.
set(CPACK_DEBIAN_TACTOGRAPH_PACKAGE_DEPENDS "fonts-dejavu-core, adduser")
set(CPACK_DEBIAN_TACTOGRAPH_PACKAGE_SUGGESTS "python3-tactograph, man-db")
set(CPACK_DEBIAN_TACTOGRAPH_PACKAGE_CONTROL_EXTRA
    "${CMAKE_SOURCE_DIR}/cmake/debian/postinst;${CMAKE_SOURCE_DIR}/cmake/debian/prerm;${CMAKE_SOURCE_DIR}/cmake/debian/postrm")
set(CPACK_COMPONENT_TACTOGRAPH_DESCRIPTION
"Records how a surface pulls on a sliding finger, turns that into a texture
(force against position), shows it as a spatial spectrogram, and plays it
back under another finger through a piezo transducer.")

set(CPACK_DEBIAN_TACTOGRAPH-DEV_PACKAGE_NAME tactograph-dev)
set(CPACK_DEBIAN_TACTOGRAPH-DEV_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_TACTOGRAPH-DEV_PACKAGE_ARCHITECTURE all)
set(CPACK_COMPONENT_TACTOGRAPH-DEV_DESCRIPTION
"What the maker of a board needs: the core of the device as C++ sources
without any library, the description of the wire, and the JSON Schemas of
all files. All of it is under the Apache License 2.0.")

set(CPACK_DEBIAN_PYTHON3-TACTOGRAPH_PACKAGE_NAME python3-tactograph)
set(CPACK_DEBIAN_PYTHON3-TACTOGRAPH_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON3-TACTOGRAPH_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON3-TACTOGRAPH_PACKAGE_DEPENDS
    "python3, python3-numpy, python3-xarray, python3-soundfile, python3-netcdf4")
set(CPACK_DEBIAN_PYTHON3-TACTOGRAPH_PACKAGE_SUGGESTS "python3-matplotlib")
set(CPACK_COMPONENT_PYTHON3-TACTOGRAPH_DESCRIPTION
"Reads recordings, textures, playback sessions and spatial spectrograms of
tactograph into xarray datasets with units, masks and gaps, and controls
the daemon tactographd.")

include(CPack)
