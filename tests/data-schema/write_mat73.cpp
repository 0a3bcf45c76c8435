// SPDX-License-Identifier: GPL-3.0-or-later
// Writes OUT.mat of version 7.3, which `export` uses above 2 GB, for export_command_test.py, which contains
// the same formulas: force_n is i / 7, cells has three rows of two columns, column by column i / 10,
// provenance a text and a number.
#include <span>
#include <vector>

#include "data-schema/exchange/mat_file.hpp"

int main(int argc, char** argv) {
  using namespace tacto::schema;
  if (argc != 2) return 2;
  std::vector<double> force_n;
  std::vector<float> cells;
  for (int i = 0; i < 1000; ++i) force_n.push_back(i / 7.0);
  for (int i = 0; i < 6; ++i) cells.push_back(static_cast<float>(i) / 10);
  auto mat = MatWriter::create(argv[1], argv[1], MatVersion::v73);
  const MatMembers members{{"program", "tactograph"}, {"gain", 0.1}};
  return mat && mat->put("force_n", force_n) && mat->put("cells", cells, 2) &&
                 mat->put("provenance", members) && mat->close()
             ? 0
             : 1;
}
