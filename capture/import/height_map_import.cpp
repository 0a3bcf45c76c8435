// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/height_map_import.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include "capture/import/height_profile.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/sha256.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/version.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::HeightMap;
using schema::Result;

struct HeightPng {
  std::size_t columns = 0, rows = 0;
  int bits = 16;                 // of a sample in the file
  std::vector<float> of_full{};  // row by row, from the lowest row of the picture: 0 black, 1 white
};

// libpng reports an error by a jump out of its functions: nothing with a destructor lives in a function that
// sets a jump.
class PngReader {
 public:
  explicit PngReader(std::FILE* file)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, fault_, on_error, on_warning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)),
        file_(file) {
    if (info_ == nullptr) throw std::bad_alloc();
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  bool read_header() noexcept {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;  // NOLINT(cert-err52-cpp): libpng's interface
    png_init_io(png_, file_);
    png_read_info(png_, info_);
    return true;
  }
  // Samples of 8 bits, or of 16 in this machine's order.
  bool read_rows(png_bytep* rows) noexcept {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;  // NOLINT(cert-err52-cpp)
    if (bits() < 8) png_set_expand_gray_1_2_4_to_8(png_);
    if (bits() == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }
  std::size_t columns() const { return png_get_image_width(png_, info_); }
  std::size_t rows() const { return png_get_image_height(png_, info_); }
  int bits() const { return png_get_bit_depth(png_, info_); }
  bool is_grey() const {
    return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY &&
           png_get_valid(png_, info_, PNG_INFO_tRNS) == 0;
  }
  const char* fault() const { return fault_; }

 private:
  static void on_error(png_structp png, png_const_charp message) {
    std::snprintf(static_cast<char*>(png_get_error_ptr(png)), kLongest, "%s", message);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

  static constexpr std::size_t kLongest = 100;
  char fault_[kLongest] = "";
  png_structp png_;
  png_infop info_;
  std::FILE* file_;
};

Result<void> check_kind(const PngReader& reader, const std::string& file, bool allow_8bit) {
  if (!reader.is_grey())
    return fail(ErrorKind::unsuitable, "this PNG has colours or transparency", file,
                "a height map is a PNG with one channel, greyscale with 16 bits: export it as such");
  if (reader.bits() < 16 && !allow_8bit)
    return fail(ErrorKind::unsuitable,
                fmt::format("this PNG has {} bits: {} levels, which feel like steps", reader.bits(),
                            1 << reader.bits()),
                file, "export it with 16 bits, or add --allow-8bit");
  if (reader.columns() > schema::kMostHeights / reader.rows())
    return fail(ErrorKind::unsuitable,
                fmt::format("this PNG has {} x {} samples", reader.columns(), reader.rows()), file,
                fmt::format("a height map has at most {}; cut or resample it", schema::kMostHeights));
  return {};
}

Result<HeightPng> read_with(PngReader& reader, const std::string& file, bool allow_8bit) {
  const auto broken = [&] {
    return fail(ErrorKind::malformed, fmt::format("is not a whole PNG: {}", reader.fault()), file,
                "export it again");
  };
  if (!reader.read_header()) return broken();
  TACTO_TRY(check_kind(reader, file, allow_8bit));
  HeightPng png{reader.columns(), reader.rows(), reader.bits()};
  const bool wide = png.bits == 16;
  const std::size_t row_bytes = png.columns * (wide ? 2 : 1);
  std::vector<png_byte> bytes(row_bytes * png.rows);
  std::vector<png_bytep> rows(png.rows);
  for (std::size_t j = 0; j < png.rows; ++j) rows[j] = bytes.data() + (png.rows - 1 - j) * row_bytes;
  if (!reader.read_rows(rows.data())) return broken();
  png.of_full.resize(png.columns * png.rows);
  for (std::size_t i = 0; i < png.of_full.size(); ++i) {
    std::uint16_t sample = bytes[wide ? 0 : i];
    if (wide) std::memcpy(&sample, bytes.data() + 2 * i, 2);
    png.of_full[i] = static_cast<float>(sample) / (wide ? 65535.0F : 255.0F);
  }
  return png;
}

// Whether the file begins as a PNG does.
bool is_png(const std::string& file) {
  char beginning[8] = {};
  std::ifstream stream(file, std::ios::binary);
  return schema::is_file(file) && stream.read(beginning, sizeof beginning) &&
         png_sig_cmp(reinterpret_cast<png_const_bytep>(beginning), 0, sizeof beginning) == 0;
}

// The stored samples; gamma and colour profiles are not applied. Errors: not_found; malformed, with libpng's
// message; unsuitable: colour, transparency, more than schema::kMostHeights samples, fewer than 16 bits
// unless `allow_8bit`.
Result<HeightPng> read_height_png(const std::string& file, bool allow_8bit) try {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!opened) return fail(ErrorKind::not_found, "cannot be read", file);
  PngReader reader(opened.get());
  return read_with(reader, file, allow_8bit);
} catch (const std::bad_alloc&) {
  return fail(ErrorKind::malformed, "is too large to be read", file);
}

Result<HeightMap> map_of_png(const ImportRequest& request) {
  if (!request.pitch_m || !request.full_height_m)
    return fail(ErrorKind::usage, "a PNG says neither the distance of its pixels nor the height of white",
                request.file, "give both, for example --pitch 50um --height 200um");
  if (!(*request.full_height_m > 0 && *request.full_height_m <= schema::kLargestHeight_m))
    return fail(ErrorKind::usage, "the height of white is above 0 and at most 1 m", "--height");
  if (!request.channels.empty() || request.rate_hz || !request.time_column.empty() || request.speed_mps)
    return fail(ErrorKind::usage, "a PNG is a height map: it has no channels and no times", request.file,
                "omit --channel, --rate, --time-column and --speed");
  auto png = read_height_png(request.file, request.allow_8bit);
  TACTO_TRY(png);
  HeightMap map;
  map.columns = png->columns, map.rows = png->rows;
  map.pitch_m = *request.pitch_m;
  map.height_m = std::move(png->of_full);
  const auto full_m = static_cast<float>(*request.full_height_m);
  for (float& height : map.height_m) height *= full_m;
  if (png->bits < 16) map.notes = fmt::format("from {} bits: {} levels", png->bits, 1 << png->bits);
  return map;
}

// The whole surface of an X3P file. A map has one pitch: that of x, if the last row lies within a quarter of
// it from its place.
Result<HeightMap> map_of_surface(const ImportRequest& request) {
  constexpr double kMostOff = 0.25;
  auto surface = read_x3p_surface(request, schema::kMostHeights);
  TACTO_TRY(surface);
  const double apart_m = std::abs(surface->row_pitch_m - surface->pitch_m);
  if (surface->rows > 1 && apart_m * static_cast<double>(surface->rows) > kMostOff * surface->pitch_m)
    return fail(ErrorKind::unsuitable,
                fmt::format("its points are {:.6g} m apart along x, and {:.6g} m along y", surface->pitch_m,
                            surface->row_pitch_m),
                request.file,
                "a height map has one pitch: resample it in the program that made it; --row N takes a line");
  HeightMap map;
  map.rows = surface->rows, map.columns = surface->height_m.size() / surface->rows;
  map.pitch_m = surface->pitch_m;
  map.notes = fmt::format("{}; {}{}", surface->notes, surface->name, subtract_mean(surface->height_m));
  map.height_m.assign(surface->height_m.begin(), surface->height_m.end());
  return map;
}

Result<HeightMap> map_of_profile(const ImportRequest& request, const std::function<void(double)>& progress) {
  if (request.full_height_m || request.allow_8bit)
    return fail(ErrorKind::usage, "--height and --allow-8bit are for a PNG", request.file,
                "the scale of a profile is that of its height channel");
  if (!is_profile_request(request))
    return fail(ErrorKind::usage, "a height map is made from a greyscale PNG or a height profile",
                request.file,
                "of a table give --channel height=2*1um, and --pitch or --channel position=1*1mm");
  if (is_x3p(request.file) && !request.row && !request.column && request.points.empty())
    return map_of_surface(request);
  auto profile = read_height_profile(request, progress);
  TACTO_TRY(profile);
  HeightMap map;
  map.columns = profile->height_m.size(), map.rows = 1;
  map.pitch_m = profile->pitch_m;
  map.surface = profile->surface, map.notes = profile->notes + subtract_mean(profile->height_m);
  map.height_m.assign(profile->height_m.begin(), profile->height_m.end());
  return map;
}

}  // namespace

bool is_height_map_request(const ImportRequest& request) {
  return request.name == schema::height_map_path(request.name) || is_png(request.file);
}

Result<ImportedHeightMap> import_height_map(const ImportRequest& request,
                                            const std::function<void(double)>& progress) {
  const std::string path = schema::height_map_path(request.name);
  const auto existing = request.replace ? schema::Existing::replace : schema::Existing::keep;
  TACTO_TRY(schema::check_output_free(path, existing));
  auto map = is_png(request.file) ? map_of_png(request) : map_of_profile(request, progress);
  TACTO_TRY(map);
  const auto sum = schema::sha256_of_file(request.file);
  TACTO_TRY(sum);
  map->source = fmt::format("{} (SHA-256 {})", std::filesystem::path(request.file).filename().string(), *sum);
  if (!request.surface.empty()) map->surface = request.surface;
  if (!request.notes.empty()) map->notes += (map->notes.empty() ? "" : "; ") + request.notes;
  map->created = schema::creation_time();
  map->creator = kCreator;
  auto written = schema::write_height_map(path, *map, existing);
  if (!written && written.error().kind == ErrorKind::unsuitable) written.error().where = request.file;
  TACTO_TRY(written);
  return ImportedHeightMap{std::move(*map), path};
}

}  // namespace tacto::capture
