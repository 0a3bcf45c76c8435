// SPDX-License-Identifier: GPL-3.0-or-later
// The positions of the real bare-finger recording, read without the readers under test.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace tacto::spatial {

/// In m, at 10 kHz; empty without the data. 0.5 um per count (data/README.md).
inline std::vector<double> bare_finger() {
  std::ifstream file(std::string(TACTO_DATA) + "/bare-finger/bare_finger_10kHz.csv");
  std::vector<double> position_m;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) position_m.push_back(std::stod(line.substr(line.rfind(',') + 1)) * 0.5e-6);
  return position_m;
}

}  // namespace tacto::spatial
