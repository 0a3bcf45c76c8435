// SPDX-License-Identifier: GPL-3.0-or-later
// One file of a project, as shown in a report.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

struct ProjectFile {
  std::string path;
  schema::FileKind kind = schema::FileKind::recording;
  std::string date;       ///< of the measurement if known, otherwise of the file's creation; ISO 8601
  std::string origin;     ///< device or source file
  std::string simulated;  ///< origin of the simulation; empty for real data
  std::string data;       ///< path of its samples, or its own path if it has none
  std::string checksum;   ///< first 12 digits of the SHA-256 of its data
  std::vector<schema::ResultFigure> figures;
  std::vector<schema::ResultPicture> pictures;
  std::vector<std::string> drawings;  ///< SVG, for pictures that are more than curves
  std::string pictures_html;          ///< `pictures` as HTML, set by draw_pictures()
};

/// Checks a file (schema, samples, checksum) and reads its contents for the report. `progress` receives
/// fractions. Errors: those of reading; malformed: with the first finding of schema::check_file.
schema::Result<ProjectFile> project_file(const schema::StoredFile& file,
                                         const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
