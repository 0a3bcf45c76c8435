// SPDX-License-Identifier: GPL-3.0-or-later
// A session as netCDF-4, for xarray, MATLAB and Octave.
#pragma once

#include <string>
#include <vector>

#include "data-schema/session.hpp"

namespace tacto::schema {

/// A variable over time.
struct SessionVariable {
  const char* name;
  const char* units;  ///< SI
  const char* long_name;
  const std::vector<double>* values;  ///< as many as there are times
};

/// Dimension `time` (s), the variables over it, and what was played on what as attributes. Errors:
/// cannot_write.
Result<void> write_session_netcdf(const std::string& path, const SessionHeader& header,
                                  const std::vector<SessionVariable>& variables,
                                  const std::vector<double>& time_s);

/// What such a file says of itself.
struct SessionTable {
  std::string created, creator, device, transducer, simulated;
  std::vector<std::string> textures;
  double rate_hz = 0;
  std::size_t times = 0;
  double duration_s = 0;  ///< from the first time to the last
};

/// Whether it is netCDF of that kind.
bool is_session_netcdf(const std::string& path);

/// Errors: malformed: no netCDF, of another kind, no times or times that do not grow.
Result<SessionTable> read_session_table(const std::string& path);

}  // namespace tacto::schema
