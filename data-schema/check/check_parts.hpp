// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of check_file, one for each kind of file. Internal to this folder.
#pragma once

#include "data-schema/check/check.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

using Progress = std::function<void(double)>;

inline Finding finding_of(const Error& error) {
  return {error.where, error.remedy.empty() ? error.what : error.what + "; " + error.remedy};
}

/// Of documents that fit their schemas; `path` is the sidecar's.
std::vector<Finding> check_recording(const std::string& path, const Document& document,
                                     const Progress& progress);
std::vector<Finding> check_texture(const std::string& path, const Document& document,
                                   const Progress& progress);

/// Checks that the files exist that the scene names, that textures are forces, and reads the atoms.
std::vector<Finding> check_scene(const std::string& path, const Document& document);

/// Errors: as of check_file.
Result<Checked> check_session(const std::string& path);
Result<Checked> check_spectrogram(const std::string& path);
/// Of a spectrogram that is readable: checks its checksum, and that decibels and flags agree with its cells.
/// Errors: malformed, of reading.
Result<std::vector<Finding>> check_spectrogram_cells(const std::string& path);

/// The properties of a WAV according to its sidecar.
struct ExpectedWav {
  std::string path;
  std::string sha256;
  SampleFormat format;
  std::uint64_t frames;
  double header_rate;
  std::vector<Channel> channels;
};

/// Compares header, length, checksum and samples of the WAV with the expected ones.
std::vector<Finding> check_wav(const ExpectedWav& expected, const Progress& progress);

}  // namespace tacto::schema
