// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/session_netcdf.hpp"

#include <algorithm>

#include "data-schema/netcdf_file.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kSessionBlock = 65536;

void put_played(NetcdfWriter& file, const SessionHeader& header) {
  file.attribute("kind", "session");
  file.attribute("created", header.created);
  file.attribute("creator", header.creator);
  file.attribute("device", header.device_uri);
  file.attribute("transducer", header.transducer.name);
  if (!header.simulated.empty()) file.attribute("simulated", header.simulated);
  file.attribute("rate_hz", header.rate_hz);
  file.attribute("metres_per_count", header.metres_per_count);
  std::string names;
  for (const SessionTexture& texture : header.textures)
    names.append(names.empty() ? "" : "\n").append(texture.file);
  file.attribute("textures", names);
}

}  // namespace

Result<void> write_session_netcdf(const std::string& path, const SessionHeader& header,
                                  const std::vector<SessionVariable>& variables,
                                  const std::vector<double>& time_s) {
  NetcdfWriter file(path);
  const int time = file.dimension("time", time_s.size());
  const int axis = file.axis("time", time, "s", "time since the first tick, by the device's clock");
  const Blocks blocks{{time}, {std::min(time_s.size(), kSessionBlock)}};
  std::vector<int> ids;
  for (const SessionVariable& variable : variables)
    ids.push_back(file.values(variable.name, blocks, variable.units, variable.long_name));
  put_played(file, header);
  file.put(axis, time_s);
  for (std::size_t i = 0; i < ids.size(); ++i) file.put(ids[i], *variables[i].values);
  return file.close(path);
}

}  // namespace tacto::schema
