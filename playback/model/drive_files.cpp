// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/drive_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "data-schema/wav/wav.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

Result<void> check_name(const std::string& path, schema::Existing existing) {
  if (std::filesystem::path(path).extension() != ".wav")
    return fail(ErrorKind::usage, "the name doesn't end in .wav", path, "only WAV is written");
  return schema::check_wav_free(path, existing);
}

// Larger values would become infinite in a 32-bit float.
Result<void> check_storable(const SignalFile& file) {
  const auto& values = file.signal->values;
  const auto broken = std::ranges::find_if(
      values, [](double each) { return !(std::abs(each) <= std::numeric_limits<float>::max()); });
  if (broken == values.end()) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("sample {} would be {:g}, which is not a finite 32-bit number",
                          broken - values.begin(), *broken),
              file.path, "correct the transducer's numbers, or use a smaller --gain");
}

Result<void> write_one(schema::PendingFiles& pending, const SignalFile& file) {
  if (const auto storable = check_storable(file); !storable) return storable;
  const auto temporary = pending.add(file.path);
  TACTO_TRY(temporary);
  auto writer =
      schema::WavWriter::create(*temporary, file.signal->sample_rate_hz, 1, schema::SampleFormat::float32);
  TACTO_TRY(writer);
  if (auto written = writer->write(file.signal->values); !written) return written;
  return writer->close();
}

}  // namespace

Result<void> check_signal_files(std::span<const SignalFile> files, schema::Existing existing) {
  for (auto file = files.begin(); file != files.end(); ++file) {
    if (auto sound = check_name(file->path, existing); !sound) return sound;
    const auto same = [&](const SignalFile& other) { return schema::same_file(file->path, other.path); };
    if (std::any_of(files.begin(), file, same))
      return fail(ErrorKind::usage, "the name is given to two outputs", file->path,
                  "name each file differently");
  }
  return {};
}

Result<void> write_signal_files(std::span<const SignalFile> files, schema::Existing existing) {
  schema::PendingFiles pending;
  for (const SignalFile& file : files)
    if (auto written = write_one(pending, file); !written) return written;
  return pending.commit(existing);
}

}  // namespace tacto::playback
