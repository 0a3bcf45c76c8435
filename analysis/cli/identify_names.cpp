// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/identify_names.hpp"

#include <fmt/format.h>

#include "data-schema/files.hpp"

namespace tacto::analysis {

schema::Result<void> check_named(const std::string& stem, const std::string& results,
                                 const std::string& picture) {
  if (!stem.empty()) return {};
  std::string name = "NAME", beside;
  if (!picture.empty()) {
    name = picture.substr(0, picture.rfind('.'));
    beside = fmt::format("; --picture {} is drawn beside it", picture);
  }
  if (!results.empty()) {
    name = schema::stem_of(results, ".results");
    beside = fmt::format("; --results {} is written beside it", results);
  }
  return schema::fail(schema::Fault::usage, "the transducer file, which identify always writes, has no name",
                      "--output", fmt::format("add -o {} for {}.transducer.json{}", name, name, beside));
}

}  // namespace tacto::analysis
