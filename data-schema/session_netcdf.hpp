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

/// Textures that took the place of those before, from a time on.
struct SessionTurn {
  double from_s = 0;                     ///< since the first tick
  double fade_s = 0;                     ///< over which they came in
  std::vector<SessionTexture> textures;  ///< none: the session does not name them
};

/// Dimension `time` (s), the variables over it, and what was played on what as attributes. Errors:
/// cannot_write.
Result<void> write_session_netcdf(const std::string& path, const SessionHeader& header,
                                  const std::vector<SessionTurn>& turns,
                                  const std::vector<SessionVariable>& variables,
                                  const std::vector<double>& time_s);

/// What such a file says of itself.
struct SessionTable {
  std::string created, creator, device, transducer, simulated;
  std::vector<std::string> textures;
  std::vector<std::string> changes;  ///< "from 1.9 s on, over 0.05 s: FILE", of each texture
  double rate_hz = 0;
  std::size_t times = 0;
  double duration_s = 0;  ///< from the first time to the last
};

/// Whether it is netCDF of that kind.
bool is_session_netcdf(const std::string& path);

/// Errors: malformed: no netCDF, of another kind, no times or times that do not grow.
Result<SessionTable> read_session_table(const std::string& path);

}  // namespace tacto::schema
