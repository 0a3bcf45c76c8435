// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/height_map_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "capture/import/height_png.hpp"
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

Result<HeightMap> map_of_profile(const ImportRequest& request, const std::function<void(double)>& progress) {
  if (request.full_height_m || request.allow_8bit)
    return fail(ErrorKind::usage, "--height and --allow-8bit are for a PNG", request.file,
                "the scale of a profile is that of its height channel");
  if (!is_profile_request(request))
    return fail(ErrorKind::usage, "a height map is made from a greyscale PNG or a height profile",
                request.file,
                "of a table give --channel height=2*1um, and --pitch or --channel position=1*1mm");
  auto profile = read_height_profile(request, progress);
  TACTO_TRY(profile);
  HeightMap map;
  map.columns = profile->height_m.size(), map.rows = 1;
  map.pitch_m = profile->pitch_m;
  map.height_m.assign(profile->height_m.begin(), profile->height_m.end());
  map.surface = profile->surface, map.notes = profile->notes;
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
  TACTO_TRY(schema::write_height_map(path, *map, existing));
  return ImportedHeightMap{std::move(*map), path};
}

}  // namespace tacto::capture
