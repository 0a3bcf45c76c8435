// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/corpus_workflow.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <set>
#include <string_view>

#include "analysis/corpus/corpus_status.hpp"
#include "analysis/corpus/corpus_unit.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::Result;

// `corpus run` with both steps, 60 recordings of 2 s at 10 kHz: 23 ms of CPU each (spatial alone: 14 ms).
constexpr double kWorkPerFrame_s = 23e-3 / 20000;
constexpr double kShard_s = 60;         // an empty task of an array takes Slurm some 2 s
constexpr std::size_t kMostRead = 100;  // sidecars from which the frames of all are estimated

std::optional<double> whole_number(std::string_view text) {
  unsigned value = 0;
  const auto [stop, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (wrong != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

// "1:30" -> 1, 30; none if one of them is no number.
std::optional<std::vector<double>> fields(std::string_view text) {
  std::vector<double> numbers;
  for (bool more = true; more;) {
    const std::size_t end = std::min(text.find(':'), text.size());
    const auto number = whole_number(text.substr(0, end));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    more = end < text.size();
    text.remove_prefix(more ? end + 1 : end);
  }
  return numbers;
}

// These become lines of a script, so nothing that could end a line or a word is accepted.
Result<void> check_word(const char* option, const std::string& text) {
  const bool plain = std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-.,+@").find(c) != std::string_view::npos;
  });
  return plain ? Result<void>{}
               : schema::fail(ErrorKind::usage, fmt::format("'{}' cannot be a name in Slurm", text), option,
                              "use letters, digits and _ - . , + @");
}

// A time limit as Slurm writes it (30, 10:00, 2:00:00, 1-12, 1-12:30 ...) in minutes; none for other text.
std::optional<double> slurm_minutes(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto days = dash == std::string::npos ? 0.0 : whole_number(std::string_view(text).substr(0, dash));
  auto parts = fields(std::string_view(text).substr(dash == std::string::npos ? 0 : dash + 1));
  if (!days || !parts || parts->size() > 3) return std::nullopt;
  // After days: hours, minutes, seconds. Otherwise minutes; minutes, seconds; hours, minutes, seconds.
  if (dash == std::string::npos && parts->size() < 3) parts->insert(parts->begin(), 0);
  parts->resize(3);
  return *days * 1440 + (*parts)[0] * 60 + (*parts)[1] + (*parts)[2] / 60;
}

// A size as Slurm writes it (500M, 4G; megabytes without a letter) in megabytes; none for other text.
std::optional<double> slurm_megabytes(const std::string& text) {
  constexpr std::string_view kLetters = "KMGT";
  const std::size_t letter = text.empty() ? std::string_view::npos : kLetters.find(text.back());
  const bool bare = letter == std::string_view::npos;
  const auto size = whole_number(std::string_view(text).substr(0, text.size() - (bare ? 0 : 1)));
  if (!size) return std::nullopt;
  return *size * std::pow(1024.0, bare ? 0.0 : static_cast<double>(letter) - 1);
}

Result<void> check_options(const CorpusWorkflowOptions& options) {
  TACTO_TRY(check_word("--account", options.account));
  TACTO_TRY(check_word("--partition", options.partition));
  if (!options.time.empty() && !slurm_minutes(options.time))
    return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a time limit of Slurm", options.time),
                        "--time", "write minutes (30), 2:00:00 or 1-12:00:00");
  // SIGTERM comes a minute before the limit; Slurm may send it a minute earlier.
  constexpr double kLeastMinutes = 3;
  if (!options.time.empty() && *slurm_minutes(options.time) < kLeastMinutes)
    return schema::fail(ErrorKind::usage, "is too short for a shard", "--time " + options.time,
                        "give three minutes or more");
  if (!options.memory.empty() && !slurm_megabytes(options.memory))
    return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a size of Slurm", options.memory), "--mem",
                        "write 500M or 4G");
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  for (const std::string& path : {schema::canonical_path(options.study), options.output})
    if (std::ranges::any_of(path, is_control))
      return schema::fail(ErrorKind::usage, "has a control character in its name", path,
                          "a script cannot contain it; rename it");
  return {};
}

// Of the recordings that can be read, at most kMostRead, evenly distributed over the plan.
void estimate(const schema::CorpusPlan& plan, const std::string& study, CorpusWorkflow& workflow) {
  const std::size_t all = plan.recordings.size(), count = std::min(all, kMostRead);
  double frames = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto recording = schema::open_recording(path_of(study, plan.recordings[i * all / count]));
    if (!recording) continue;
    frames += static_cast<double>(recording->header.frames);
    ++workflow.read;
  }
  if (workflow.read > 0)
    workflow.work_s =
        kWorkPerFrame_s * frames / static_cast<double>(workflow.read) * static_cast<double>(all);
}

// 1-3,7
std::string ranges_of(const std::vector<std::size_t>& numbers) {
  std::vector<std::string> parts;
  for (std::size_t i = 0, end = 0; i < numbers.size(); i = end) {
    for (end = i + 1; end < numbers.size() && numbers[end] == numbers[end - 1] + 1;) ++end;
    parts.push_back(end == i + 1 ? fmt::format("{}", numbers[i])
                                 : fmt::format("{}-{}", numbers[i], numbers[end - 1]));
  }
  return fmt::format("{}", fmt::join(parts, ","));
}

std::string resume_command(const CorpusWorkflowOptions& options, const CorpusWorkflow& workflow,
                           const char* engine, const std::string& study) {
  std::string command = fmt::format("tactograph corpus workflow {} --engine {} --missing --shards {}", study,
                                    engine, workflow.shards);
  for (const auto& [option, value] : {std::pair{"account", options.account},
                                      {"partition", options.partition},
                                      {"time", options.time},
                                      {"mem", options.memory}})
    if (!value.empty()) command += fmt::format(" --{} {}", option, value);
  return command + " --force -o " + cli::shell_word(options.output);
}

constexpr std::string_view kMadeBy = "# Made by 'tactograph corpus workflow'.";

// The first lines of both files.
std::string heading(const CorpusWorkflow& workflow, const std::string& study) {
  return fmt::format(
      "{}\n# Textures of the {} recordings in {}, divided into {} shards.\n"
      "# Estimated work on one core: {:.3g} s a shard (from the length of {} recordings).\n"
      "# The command 'tactograph' has to be on the PATH of each node, and the folder at the same place.\n#\n",
      kMadeBy, workflow.recordings, study, workflow.shards,
      workflow.work_s / static_cast<double>(workflow.shards), workflow.read);
}

std::string slurm_text(const CorpusWorkflowOptions& options, const CorpusWorkflow& workflow) {
  const std::string study = cli::shell_word(schema::canonical_path(options.study)),
                    file = cli::shell_word(options.output);
  std::string text = "#!/bin/bash\n" + heading(workflow, study);
  text += fmt::format(
      "# Submit:    sbatch {0}\n"
      "# Look:      squeue --me; tactograph corpus status {1}\n"
      "# Resume:    {2}\n"
      "#            sbatch {0}\n#\n"
      "# A task that is killed loses at most two seconds of work. At the time limit it gets SIGTERM a minute "
      "before,\n"
      "# completes the recording in progress, publishes all and ends with exit code 5, so Slurm calls it "
      "FAILED.\n\n",
      file, study, resume_command(options, workflow, "slurm", study));
  text += fmt::format(
      "#SBATCH --job-name=corpus\n#SBATCH --array={}\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n",
      ranges_of(workflow.listed));
  text += "#SBATCH --signal=B:TERM@60\n";
  for (const auto& [option, value] : {std::pair{"account", options.account},
                                      {"partition", options.partition},
                                      {"time", options.time},
                                      {"mem", options.memory}})
    if (!value.empty()) text += fmt::format("#SBATCH --{}={}\n", option, value);
  return text + fmt::format("\nexec tactograph corpus run {} --shard \"$SLURM_ARRAY_TASK_ID/{}\"\n", study,
                            workflow.shards);
}

std::string python_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

// The markers shards/I-of-N.done tell Snakemake what is done while it runs. At its end it removes them,
// because what is done is known by `corpus run` alone.
std::string snakemake_text(const CorpusWorkflowOptions& options, const CorpusWorkflow& workflow) {
  const std::string folder = schema::canonical_path(options.study), study = cli::shell_word(folder),
                    file = cli::shell_word(options.output);
  std::string text = heading(workflow, study);
  text += fmt::format(
      "# Run:       snakemake -s {0} --cores 4                 # on this machine\n"
      "#            snakemake -s {0} --slurm --jobs 100        # each shard as a job of Slurm\n"
      "# Look:      tactograph corpus status {1}\n"
      "# Resume:    after a run that was killed, Snakemake leaves a lock:\n"
      "#            snakemake -s {0} --unlock\n"
      "#            {2}\n"
      "#            and run it again. A shard that is killed loses at most two seconds of work.\n\n",
      file, study, resume_command(options, workflow, "snakemake", study));
  text +=
      fmt::format("workdir: {}\n\nSHARDS = [{}]\n\n", python_text(folder), fmt::join(workflow.listed, ", "));
  text += fmt::format(
      "onsuccess:\n    shell(\"rm -rf shards\")\n\nrule all:\n    input: "
      "expand(\"shards/{{shard}}-of-{0}.done\", shard=SHARDS)\n\n"
      "rule shard:\n    input: \"plan.corpus.json\"\n"
      "    output: touch(\"shards/{{shard}}-of-{0}.done\")\n    threads: 1\n",
      workflow.shards);
  std::vector<std::string> resources;
  if (!options.account.empty()) resources.push_back(fmt::format("slurm_account=\"{}\"", options.account));
  if (!options.partition.empty())
    resources.push_back(fmt::format("slurm_partition=\"{}\"", options.partition));
  if (const auto minutes = slurm_minutes(options.time))
    resources.push_back(fmt::format("runtime={:.0f}", std::ceil(*minutes)));
  if (const auto size = slurm_megabytes(options.memory))
    resources.push_back(fmt::format("mem_mb={:.0f}", std::ceil(*size)));
  if (!resources.empty()) text += fmt::format("    resources: {}\n", fmt::join(resources, ", "));
  return text + fmt::format("    shell: \"exec tactograph corpus run . --shard {{wildcards.shard}}/{}\"\n",
                            workflow.shards);
}

}  // namespace

bool is_workflow(std::string_view first_line) {
  return first_line == kMadeBy;
}

Result<CorpusWorkflow> corpus_workflow(const CorpusWorkflowOptions& options) {
  TACTO_TRY(check_options(options));
  const auto plan = schema::read_corpus_plan(corpus_plan_path(options.study));
  TACTO_TRY(plan);
  CorpusWorkflow workflow;
  workflow.recordings = plan->recordings.size();
  estimate(*plan, options.study, workflow);
  const auto most = std::min(kMostShards, workflow.recordings);
  workflow.shards = options.shards.value_or(
      std::clamp(static_cast<std::size_t>(workflow.work_s / kShard_s), std::size_t{1}, most));
  if (options.missing) {
    const auto status = corpus_status(options.study, false);
    TACTO_TRY(status);
    std::set<std::size_t> listed;
    for (const CorpusUnitStatus& unit : status->units)
      if (unit.unit.state == UnitState::missing || unit.unit.state == UnitState::damaged)
        listed.insert(unit.recording % workflow.shards + 1);
    workflow.listed.assign(listed.begin(), listed.end());
    if (listed.empty())
      return schema::fail(ErrorKind::unsuitable, "has all results: nothing is missing", options.study,
                          "'tactograph corpus status' lists failures");
  } else {
    workflow.listed.resize(std::min(workflow.shards, workflow.recordings));
    std::iota(workflow.listed.begin(), workflow.listed.end(), std::size_t{1});
  }
  workflow.text = options.engine == WorkflowEngine::slurm ? slurm_text(options, workflow)
                                                          : snakemake_text(options, workflow);
  return workflow;
}

}  // namespace tacto::analysis
