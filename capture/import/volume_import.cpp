// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/volume_import.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/version.hpp"
#include "data-schema/volume/volume.hpp"

namespace tacto::capture {

using schema::Result;

bool is_volume_request(const ImportRequest& request) {
  return schema::is_nrrd_file(request.file);
}

Result<ImportedVolume> import_volume(const ImportRequest& request) {
  if (!request.channels.empty() || request.rate_hz || !request.time_column.empty() || request.speed_mps ||
      request.pitch_m || request.full_height_m || request.repair || request.open)
    return schema::fail(
        schema::ErrorKind::usage, "a volume has no channels, no times and no triangles", request.file,
        "omit --channel, --rate, --time-column, --speed, --pitch, --height, --repair and --open");
  ImportedVolume imported;
  imported.path = schema::volume_path(request.name);
  const auto existing = request.replace ? schema::Existing::replace : schema::Existing::keep;
  TACTO_TRY(schema::check_output_free(imported.path, existing));
  auto read = schema::read_nrrd(request.file, request.unit_m);
  TACTO_TRY(read);
  imported.read = std::move(*read);
  const auto sum = schema::sha256_of_file(request.file);
  TACTO_TRY(sum);
  schema::Volume& volume = imported.read.volume;
  volume.source =
      fmt::format("{} (SHA-256 {})", std::filesystem::path(request.file).filename().string(), *sum);
  volume.notes = request.notes;
  volume.created = schema::creation_time();
  volume.creator = kCreator;
  TACTO_TRY(schema::write_volume(imported.path, volume, existing));
  return imported;
}

}  // namespace tacto::capture
