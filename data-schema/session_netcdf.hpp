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

}  // namespace tacto::schema
