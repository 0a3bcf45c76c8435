// SPDX-License-Identifier: GPL-3.0-or-later
// The workload as a table of another program, for import and NumPy's loadtxt.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "tests/bench/workload.hpp"

namespace tacto::bench {

/// "time_s,force_V,count", 60 s: 600,000 rows, 16 MB, in the format of scipy_columns.py's table: six digits
/// of time, nine of force, integer counts.
inline std::string workload_csv() {
  const Workload made = workload(60);
  std::string text = "time_s,force_V,count\n";
  for (std::size_t i = 0; i < made.force_n.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{:.6f},{:.9f},{}\n", static_cast<double>(i) / kRate_hz,
                   made.force_n[i], std::lround(made.position_m[i] / kQuantum_m));
  return text;
}

/// The table on disk, in the folder for temporary files, written once.
inline std::string workload_csv_file() {
  namespace fs = std::filesystem;
  const fs::path path = fs::temp_directory_path() / "tacto-bench-60s.csv";
  const std::string text = workload_csv();
  std::error_code unknown;
  if (fs::file_size(path, unknown) != text.size()) std::ofstream(path, std::ios::binary) << text;
  return path.string();
}

}  // namespace tacto::bench
