// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/corpus_init.hpp"

#include <filesystem>
#include <map>

#include "analysis/corpus/corpus_steps.hpp"
#include "analysis/corpus/corpus_unit.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::Result;

// Relative paths start at the study's folder, so that both can be moved together. Links to folders are
// resolved, because ".." behind one leads elsewhere; the recording's own name stays.
class PathsInPlan {
 public:
  explicit PathsInPlan(const std::string& study) : study_(schema::canonical_path(study)) {
    if (!study_.has_filename()) study_ = study_.parent_path();  // "study/"
  }

  std::string of(const fs::path& path) {
    if (path.is_absolute()) return path.string();
    auto& folder = folders_[path.parent_path().string()];
    if (folder.empty()) folder = schema::canonical_path(path.has_parent_path() ? path.parent_path() : ".");
    return (fs::path(folder) / path.filename()).lexically_relative(study_).string();
  }

 private:
  fs::path study_;
  std::map<std::string, std::string> folders_;  // canonical
};

}  // namespace

Result<NewCorpus> init_corpus(const CorpusInput& input, const std::function<void(double)>& progress) {
  const std::string path = corpus_plan_path(input.study);
  TACTO_TRY(schema::check_output_free(path, input.existing));
  TACTO_TRY(parse_steps(input.steps));
  const auto found = find_recordings(input.patterns);
  TACTO_TRY(found);
  PathsInPlan paths(input.study);
  NewCorpus made{{input.steps, {}, schema::creation_time(), std::string(kCreator), {}, {}, {}},
                 found->others};
  auto& recordings = made.plan.recordings;
  recordings.reserve(found->paths.size());
  for (const std::string& recording : found->paths) {
    auto sum = schema::sha256_of_file(recording);
    TACTO_TRY(sum);
    recordings.push_back({paths.of(recording), std::move(*sum)});
    progress(static_cast<double>(recordings.size()) / static_cast<double>(found->paths.size()));
  }
  const auto text = schema::corpus_plan_json(made.plan);
  TACTO_TRY(text);
  schema::PendingFiles pending;
  TACTO_TRY(pending.write(path, *text));
  TACTO_TRY(pending.commit(input.existing));
  return made;
}

}  // namespace tacto::analysis
