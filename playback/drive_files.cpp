// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/drive_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "data-schema/files.hpp"
#include "data-schema/wav.hpp"

namespace tacto::playback {

using schema::fail;
using schema::Fault;
using schema::Result;

namespace {

Result<void> check_name(const std::string& path) {
  namespace fs = std::filesystem;
  if (fs::path(path).extension() != ".wav")
    return fail(Fault::usage, "the name doesn't end in .wav", path, "only WAV is written");
  std::error_code ignored;
  if (fs::exists(fs::path(path).replace_extension(".json"), ignored))
    return fail(Fault::usage, "this name belongs to a recording or texture", path, "choose another name");
  return {};
}

Result<void> write_one(schema::PendingFiles& pending, const SignalFile& file) {
  const auto temporary = pending.add(file.path);
  if (!temporary) return schema::forward_error(temporary);
  auto writer =
      schema::WavWriter::create(*temporary, file.signal->sample_rate_hz, 1, schema::SampleFormat::float32);
  if (!writer) return schema::forward_error(writer);
  if (auto written = writer->write(file.signal->values); !written) return written;
  return writer->close();
}

}  // namespace

Result<void> check_signal_files(std::span<const SignalFile> files) {
  std::set<std::string> names;
  for (const SignalFile& file : files) {
    if (auto sound = check_name(file.path); !sound) return sound;
    if (!names.insert(std::filesystem::path(file.path).lexically_normal().string()).second)
      return fail(Fault::usage, "the name is given to two outputs", file.path, "name each file differently");
  }
  return {};
}

Result<void> write_signal_files(std::span<const SignalFile> files) {
  schema::PendingFiles pending;
  for (const SignalFile& file : files)
    if (auto written = write_one(pending, file); !written) return written;
  return pending.commit();
}

}  // namespace tacto::playback
