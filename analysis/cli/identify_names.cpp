// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/identify_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "data-schema/files/files.hpp"

namespace tacto::analysis {

namespace {

// Two outputs of the same name would overwrite each other.
schema::Result<void> check_apart(const std::vector<std::string>& files) {
  for (auto file = files.begin(); file != files.end(); ++file)
    if (!file->empty() && std::any_of(files.begin(), file, [&](const auto& other) {
          return !other.empty() && schema::same_file(*file, other);
        }))
      return schema::fail(schema::ErrorKind::usage, "is named twice", *file,
                          "give transducer, picture and results different names");
  return {};
}

}  // namespace

schema::Result<void> check_named(const std::string& stem, const std::string& results,
                                 const std::string& picture) {
  if (!stem.empty())
    return check_apart({schema::stem_of(stem, ".transducer") + ".transducer.json", picture, results});
  std::string name = "NAME", beside;
  if (!picture.empty()) {
    name = picture.substr(0, picture.rfind('.'));
    beside = fmt::format("; --picture {} is drawn beside it", picture);
  }
  if (!results.empty()) {
    name = schema::stem_of(results, ".results");
    beside = fmt::format("; --results {} is written beside it", results);
  }
  return schema::fail(schema::ErrorKind::usage,
                      "the transducer file, which identify always writes, has no name", "--output",
                      fmt::format("add -o {} for {}.transducer.json{}", name, name, beside));
}

}  // namespace tacto::analysis
