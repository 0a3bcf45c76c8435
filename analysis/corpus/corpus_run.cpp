// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/corpus_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <vector>

#include "analysis/corpus/corpus_steps.hpp"
#include "analysis/corpus/corpus_unit.hpp"
#include "analysis/corpus/work_folder.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/files/process_mark.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::Result;
using Clock = std::chrono::steady_clock;

// A batch is synced at once: after so many units or so long. A run that is killed loses at most one.
constexpr std::size_t kBatchUnits = 64;
constexpr std::chrono::seconds kBatchTime{2};

// A unit that is complete in the working folder.
struct MadeUnit {
  std::string work, folder;
  bool replaces = false;  // a damaged unit, or a failure that may succeed
  bool failed = false;
};

bool is_final(const Unit& unit) {
  return unit.state == UnitState::done || (unit.state == UnitState::failed && !unit.may_succeed);
}

// Moves an unusable unit away. If another run has repaired it since it was read, that one is moved back.
void set_aside(const std::string& folder, const std::string& aside) {
  if (std::rename(folder.c_str(), aside.c_str()) != 0) return;
  if (is_final(read_unit(aside, true))) std::rename(aside.c_str(), folder.c_str());
  remove_folder(aside);
}

// Removes the folders from a message: it has to be the same on every machine.
std::string without(std::string text, const std::vector<std::string>& folders) {
  for (const std::string& folder : folders)
    for (std::size_t at = 0; (at = text.find(folder, at)) != std::string::npos;)
      if (at == 0 || std::string_view(" '\"(").find(text[at - 1]) != std::string_view::npos)
        text.erase(at, folder.size());
      else
        ++at;  // the end of another word
  for (char& letter : text)
    if (letter == '\n') letter = ' ';
  return text;
}

class CorpusRun {
 public:
  CorpusRun(const CorpusRunOptions& options, const schema::CorpusPlan& plan, const CorpusSteps& steps,
            const WorkFolder& work, const std::function<void(double)>& progress,
            const std::function<bool()>& stopped)
      : options_(options), plan_(plan), steps_(steps), work_(work), progress_(progress), stopped_(stopped) {
    choose_recordings();
  }

  Result<CorpusRunCounts> run() {
    {
      std::vector<std::jthread> workers;
      for (std::size_t i = 0; i < std::min(options_.jobs, chosen_.size()); ++i)
        workers.emplace_back([this] { work_through(); });
    }
    publish(waiting_);
    if (counts_.made > 0) keep(sync_file_system(options_.study));  // the new names
    counts_.recordings = chosen_.size();
    if (failure_) return tl::unexpected(*failure_);
    return counts_;
  }

 private:
  // Those of the shard, each input once. Runs at the same time start at different places, so that they seldom
  // compute the same unit.
  void choose_recordings() {
    std::set<std::string> keys;
    for (std::size_t i = options_.shard - 1; i < plan_.recordings.size(); i += options_.shards)
      if (keys.insert(unit_keys(plan_, plan_.recordings[i]).front()).second)
        chosen_.push_back(&plan_.recordings[i]);
    if (chosen_.empty()) return;
    constexpr int kHexadecimal = 16;
    const std::string digits = schema::sha256_of(schema::text_of(schema::own_mark())).substr(0, 8);
    const auto first = std::stoul(digits, nullptr, kHexadecimal) % chosen_.size();
    std::rotate(chosen_.begin(), chosen_.begin() + static_cast<std::ptrdiff_t>(first), chosen_.end());
  }

  void work_through() {
    for (std::size_t i = next_++; i < chosen_.size() && !ends(); i = next_++) {
      process(*chosen_[i]);
      const std::lock_guard lock(mutex_);
      progress_(static_cast<double>(++finished_) / static_cast<double>(chosen_.size()));
    }
  }

  bool ends() {
    const std::lock_guard lock(mutex_);
    counts_.stopped = counts_.stopped || stopped_();
    return counts_.stopped || failure_.has_value();
  }

  void add_one(std::size_t CorpusRunCounts::*which) {
    const std::lock_guard lock(mutex_);
    ++(counts_.*which);
  }

  void keep(const Result<void>& result) {
    const std::lock_guard lock(mutex_);
    if (!result && !failure_) failure_ = result.error();
  }

  void process(const schema::CorpusRecording& recording) {
    const std::vector<std::string> keys = unit_keys(plan_, recording);
    std::vector<MadeUnit> made;
    std::string input;  // the folder of the step before
    for (std::size_t step = 0; step < keys.size(); ++step) {
      const std::string folder = unit_folder(options_.study, keys[step]);
      const Unit stored = read_unit(folder, options_.verify);
      if (is_final(stored)) {
        add_one(&CorpusRunCounts::present);
        if (stored.state == UnitState::failed) break;
        input = folder;
        continue;
      }
      const std::string work = work_.of(keys[step]);
      const auto failed = make(recording, step, input, work);
      if (!failed) return keep(schema::forward_error(failed));
      made.push_back({work, folder, stored.state != UnitState::missing, *failed});
      if (*failed) break;
      input = work;
    }
    if (!made.empty()) add_one(&CorpusRunCounts::worked_on);
    add(std::move(made));
  }

  // Whether the unit is a failure. Errors: cannot_write.
  Result<bool> make(const schema::CorpusRecording& recording, std::size_t step, const std::string& input,
                    const std::string& work) const {
    const std::string path = path_of(options_.study, recording);
    remove_folder(work);
    TACTO_TRY(make_folder(work));
    const auto warnings = results(recording, path, step, input, work);
    if (!warnings && warnings.error().kind == ErrorKind::cannot_write) return schema::forward_error(warnings);
    const std::string from = fs::path(path).parent_path().string();
    std::vector<std::string> folders{work + "/"};
    if (!input.empty()) folders.push_back(input + "/");
    if (!from.empty()) folders.push_back(from + "/");
    if (!warnings) {
      remove_folder(work);
      TACTO_TRY(make_folder(work));
      TACTO_TRY(
          write_failure(work, warnings.error().kind, without(schema::message(warnings.error()), folders)));
    } else if (!warnings->empty()) {
      std::vector<std::string> lines;
      for (const std::string& warning : *warnings) lines.push_back(without(warning, folders));
      TACTO_TRY(write_warnings(work, lines));
    }
    TACTO_TRY(seal_unit(work));
    return !warnings;
  }

  Result<std::vector<std::string>> results(const schema::CorpusRecording& recording, const std::string& path,
                                           std::size_t step, const std::string& input,
                                           const std::string& work) const {
    if (step > 0) {
      const auto made = make_descriptions(steps_.description, path, input, work);
      TACTO_TRY(made);
      return std::vector<std::string>{};
    }
    const auto sum = schema::sha256_of_file(path);
    TACTO_TRY(sum);
    if (*sum == recording.sha256) return make_textures(steps_.spatial, path, work);
    return schema::fail(ErrorKind::not_found, "is not the recording of the plan: its SHA-256 differs", path,
                        "restore it, or make a new plan with 'tactograph corpus init --force'");
  }

  // The units of one recording stay together: its description reads its textures.
  void add(std::vector<MadeUnit> made) {
    std::vector<MadeUnit> batch;
    {
      const std::lock_guard lock(mutex_);
      waiting_.insert(waiting_.end(), made.begin(), made.end());
      if (waiting_.size() < kBatchUnits && Clock::now() < batch_since_ + kBatchTime) return;
      batch.swap(waiting_);
      batch_since_ = Clock::now();
    }
    publish(batch);
  }

  void publish(const std::vector<MadeUnit>& batch) {
    if (batch.empty()) return;
    if (const auto synced = sync_file_system(options_.study); !synced) return keep(synced);
    for (const MadeUnit& unit : batch) keep(publish(unit));
  }

  void count(const MadeUnit& unit) {
    add_one(&CorpusRunCounts::made);
    if (unit.failed) add_one(&CorpusRunCounts::failed);
  }

  Result<void> publish(const MadeUnit& unit) {
    TACTO_TRY(make_folder(fs::path(unit.folder).parent_path().string()));
    if (unit.replaces) set_aside(unit.folder, unit.work + ".aside");
    if (std::rename(unit.work.c_str(), unit.folder.c_str()) == 0) {
      count(unit);
      return {};
    }
    const int why = errno;
    std::error_code ignored;
    if (why == ENOENT &&
        fs::exists(unit.folder, ignored)) {  // NFS: the reply was lost and the request repeated
      count(unit);
      return {};
    }
    if (why != EEXIST && why != ENOTEMPTY) return unwritable(unit.folder, why);
    remove_folder(unit.work);
    add_one(&CorpusRunCounts::others);
    return {};
  }

  const CorpusRunOptions& options_;
  const schema::CorpusPlan& plan_;
  const CorpusSteps& steps_;
  const WorkFolder& work_;
  const std::function<void(double)>& progress_;
  const std::function<bool()>& stopped_;
  std::vector<const schema::CorpusRecording*> chosen_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;  // of all below
  std::size_t finished_ = 0;
  CorpusRunCounts counts_;
  std::vector<MadeUnit> waiting_;
  Clock::time_point batch_since_ = Clock::now();
  std::optional<schema::Error> failure_;
};

}  // namespace

Result<CorpusRunCounts> run_corpus(const CorpusRunOptions& options,
                                   const std::function<void(double)>& progress,
                                   const std::function<bool()>& stopped) {
  const std::string path = corpus_plan_path(options.study);
  const auto plan = schema::read_corpus_plan(path);
  TACTO_TRY(plan);
  if (plan->creator != kCreator)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("is a plan for {}, but this is {}", plan->creator, kCreator), path,
                        "use that version, or make a new plan with 'tactograph corpus init --force'");
  auto steps = parse_steps(plan->steps);
  if (!steps) steps.error().where = path + ": " + steps.error().where;
  TACTO_TRY(steps);
  const WorkFolder work((fs::path(options.study) / "work").string());
  const std::size_t removed = work.remove_ended();
  TACTO_TRY(work.make());
  auto counts = CorpusRun(options, *plan, *steps, work, progress, stopped).run();
  if (counts) counts->removed = removed;
  return counts;
}

}  // namespace tacto::analysis
