// SPDX-License-Identifier: GPL-3.0-or-later
// A session as netCDF-4, for xarray, MATLAB and Octave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data-schema/session/session.hpp"

namespace tacto::schema {

/// A variable over time.
struct SessionVariable {
  const char* name;
  const char* units;  ///< SI
  const char* long_name;
};

/// Textures that replaced the earlier ones, from a time on.
struct SessionTurn {
  double from_s = 0;                     ///< since the first tick
  double fade_s = 0;                     ///< duration of the fade
  std::vector<SessionTexture> textures;  ///< none: the session does not name them
};

class NetcdfWriter;

/// Dimension `time` (s), the variables over it, and the program as attributes, written in parts: the file
/// depends on the numbers, not on the parts.
class SessionNetcdf {
 public:
  SessionNetcdf(const std::string& path, const SessionHeader& header, std::uint64_t times,
                const std::vector<SessionVariable>& variables);
  SessionNetcdf(const SessionNetcdf&) = delete;
  SessionNetcdf& operator=(const SessionNetcdf&) = delete;
  ~SessionNetcdf();

  /// The next time, and the value of each variable at that time.
  void add(double time_s, std::span<const double> values);
  /// Call after the last time. Errors: cannot_write, of any call.
  Result<void> close(const std::vector<SessionTurn>& turns);

 private:
  void put_block();

  std::string path_;
  std::unique_ptr<NetcdfWriter> file_;
  int axis_ = -1;
  std::vector<int> ids_;
  std::vector<double> time_s_;
  std::vector<std::vector<double>> values_;  // of a block, by variable
  std::size_t put_ = 0;
};

/// The header data of such a file.
struct SessionTable {
  std::string newer_version;  ///< set by the reader if the file's minor version is newer than ours
  std::string created, creator, device, transducer, simulated;
  std::vector<std::string> textures;
  std::vector<std::string> changes;  ///< "from 1.9 s on, over 0.05 s: FILE", of each texture
  double rate_hz = 0;
  std::size_t times = 0;
  double duration_s = 0;  ///< from the first time to the last
};

/// Whether it is a netCDF file of that kind.
bool is_session_netcdf(const std::string& path);

/// Errors: malformed: no netCDF, of another kind, no times or times that do not grow; of newer_version().
Result<SessionTable> read_session_table(const std::string& path);

}  // namespace tacto::schema
