// SPDX-License-Identifier: GPL-3.0-or-later
// A stored file as a MATLAB file.
#pragma once

#include <string>

#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::schema {

/// Whether export_mat() takes this kind: recording, texture, spectrogram, session.
bool is_mat_kind(FileKind kind);

/// SI units, names with their unit. Memory: one channel of a recording, all ticks of a session. Errors: of
/// reading the file; usage, for an existing file; cannot_write.
Result<cli::Report> export_mat(const StoredFile& file, const std::string& output, Existing existing);

}  // namespace tacto::schema
