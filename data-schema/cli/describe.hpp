// SPDX-License-Identifier: GPL-3.0-or-later
// The reports of `info` for each kind of file.
#pragma once

#include <string>

#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/texture/transform.hpp"
#include "data-schema/volume/volume.hpp"

namespace tacto::schema {

/// Reads the file and describes it; warns of a newer minor version and of unknown members. Errors: as of
/// reading such a file.
Result<cli::Report> describe_recording(const std::string& path);
Result<cli::Report> describe_texture(const std::string& path);
Result<cli::Report> describe_transducer(const std::string& path);
Result<cli::Report> describe_spectrogram(const std::string& path);
Result<cli::Report> describe_formants(const std::string& path);
Result<cli::Report> describe_descriptions(const std::string& path);
Result<cli::Report> describe_calibration(const std::string& path);
Result<cli::Report> describe_scene(const std::string& path);
Result<cli::Report> describe_session(const std::string& path);
Result<cli::Report> describe_session_table(const std::string& path);
Result<cli::Report> describe_height_map(const std::string& path);
Result<cli::Report> describe_mesh(const std::string& path);
Result<cli::Report> describe_volume(const std::string& path);
Result<cli::Report> describe_results(const std::string& path);
Result<cli::Report> describe_trade(const std::string& path);
Result<cli::Report> describe_device(const std::string& path);
Result<cli::Report> describe_hand(const std::string& path);
Result<cli::Report> describe_corpus(const std::string& path);
Result<cli::Report> describe_protocol(const std::string& path);
Result<cli::Report> describe_protocol_key(const std::string& path);
Result<cli::Report> describe_wiring(const std::string& path);

/// The report's first lines: file, kind, and what simulated it.
cli::Report report_of(FileKind kind, const std::string& path, const std::string& simulated);

/// A table of the strokes that were detected during recording, if there are any.
void add_strokes(cli::Report& report, const RecordingHeader& header);

/// Tables of the textures that it was made from and of the operations.
void add_transform(cli::Report& report, const TextureTransform& transform);

/// Triangles, vertices, size, longest edge; the volume if it is closed, otherwise the edges of its holes.
void add_mesh(cli::Report& report, const Mesh& mesh);

/// Values along each axis, spacing, size, smallest and largest value, steepest slope.
void add_volume(cli::Report& report, const Volume& volume);

/// Adds the text if there is one.
void add_text(cli::Report& report, const char* key, const std::string& text);

/// Warns on stderr of a newer minor version and of unknown members.
template <class File>
void warn_of_unknown(const std::string& path, const File& file) {
  if (const std::string note = unknown_note(path, file); !note.empty()) cli::warn(note);
}

}  // namespace tacto::schema
