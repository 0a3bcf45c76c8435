# SPDX-License-Identifier: GPL-3.0-or-later
# Finds every external library once. CONTRIBUTING.md lists the use of each.

find_package(PkgConfig REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tl-expected REQUIRED)
find_package(pugixml REQUIRED)
pkg_check_modules(SNDFILE REQUIRED IMPORTED_TARGET sndfile)
pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3)
pkg_check_modules(FFTWF REQUIRED IMPORTED_TARGET fftw3f)
pkg_check_modules(NETCDF REQUIRED IMPORTED_TARGET netcdf)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial)
pkg_check_modules(MATIO REQUIRED IMPORTED_TARGET matio)
pkg_check_modules(ZIP REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
pkg_check_modules(LIBUSB REQUIRED IMPORTED_TARGET libusb-1.0)
pkg_check_modules(COMEDI REQUIRED IMPORTED_TARGET comedilib)
pkg_check_modules(NETTLE REQUIRED IMPORTED_TARGET nettle)
pkg_check_modules(PANGOCAIRO REQUIRED IMPORTED_TARGET pangocairo)
pkg_check_modules(CAIRO_SVG REQUIRED IMPORTED_TARGET cairo-svg cairo-png)
pkg_check_modules(PNG REQUIRED IMPORTED_TARGET libpng)

# Debian ships OpenCVConfig.cmake only with all of OpenCV (libopencv-dev); two modules are named here instead.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
find_library(OPENCV_CORE opencv_core REQUIRED)
find_library(OPENCV_IMGPROC opencv_imgproc REQUIRED)
add_library(tacto_opencv INTERFACE)
target_include_directories(tacto_opencv SYSTEM INTERFACE ${OPENCV_INCLUDE_DIR})
target_link_libraries(tacto_opencv INTERFACE ${OPENCV_IMGPROC} ${OPENCV_CORE})

# Eigen is headers only; SYSTEM switches off our warnings in them.
find_path(EIGEN_INCLUDE_DIR Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)
add_library(tacto_eigen INTERFACE)
target_include_directories(tacto_eigen SYSTEM INTERFACE ${EIGEN_INCLUDE_DIR})

# Boost.Math is headers only, in the compiler's own path; this says what is missing before the compiler does.
find_path(BOOST_MATH_INCLUDE_DIR boost/math/distributions.hpp REQUIRED)

# Valijson is headers only.
find_path(VALIJSON_INCLUDE_DIR valijson/validator.hpp REQUIRED)
add_library(tacto_valijson INTERFACE)
target_include_directories(tacto_valijson SYSTEM INTERFACE ${VALIJSON_INCLUDE_DIR})

# The page of `tactograph live`; a build without one of the three leaves it out.
pkg_check_modules(WEBSOCKETS IMPORTED_TARGET libwebsockets)
find_program(TACTO_CLANGXX clang++-16)
find_program(TACTO_WASM_LD wasm-ld-16)
if(WEBSOCKETS_FOUND AND TACTO_CLANGXX AND TACTO_WASM_LD)
  set(TACTO_LIVE ON)
else()
  set(TACTO_LIVE OFF)
  message(STATUS "tactograph live is left out: it needs libwebsockets-dev, clang-16 and lld-16")
endif()
