// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph corpus: textures and descriptions of many recordings, as one job that can be interrupted.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <utility>
#include <vector>

#include "analysis/cli/verbs.hpp"
#include "analysis/corpus/corpus_init.hpp"
#include "analysis/corpus/corpus_pack.hpp"
#include "analysis/corpus/corpus_run.hpp"
#include "analysis/corpus/corpus_status.hpp"
#include "analysis/corpus/corpus_workflow.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Result;

struct InitOptions {
  CorpusInput input;
  bool describes = true;
  std::string spatial, describe;
};

Result<Report> run_init(InitOptions options) {
  CorpusInput& input = options.input;
  input.steps = {{"spatial", options.spatial}};
  if (options.describes) input.steps.push_back({"describe", options.describe});
  if (!options.describes && !options.describe.empty())
    return schema::fail(ErrorKind::usage, "is no step of the plan", "--describe", "add it to --steps");
  cli::Progress progress("checksums");
  const auto made = init_corpus(input, [&](double fraction) { progress.update(fraction); });
  TACTO_TRY(made);
  Report report;
  report.add("plan", corpus_plan_path(input.study)).add("recordings", made->plan.recordings.size());
  if (made->others > 0) report.add("skipped_other_files", made->others);
  return report.add("next", "tactograph corpus run " + cli::shell_word(input.study));
}

cli::Action declare_init(CLI::App& app) {
  const auto options = std::make_shared<InitOptions>();
  app.add_option("STUDY", options->input.study, "Folder for the plan and the results")->required();
  app.add_option("--recordings", options->input.patterns,
                 "Recordings, folders of them, or patterns in quotes: 'raw/**/*.json'")
      ->required();
  cli::add_choice<bool>(app, "--steps", options->describes, {{"spatial,describe", true}, {"spatial", false}},
                        "Textures, or also a description of each recording's textures");
  app.add_option("--spatial", options->spatial, "Options of spatial: '--average --band 15Hz..300Hz'")
      ->type_name("OPTIONS");
  app.add_option("--describe", options->describe, "Options of describe: '--window 5mm'")
      ->type_name("OPTIONS");
  cli::declare_force(app, options->input.existing);
  return [options] { return run_init(*options); };
}

Result<std::size_t> count_in(std::string_view text, const std::string& shard) {
  std::size_t count = 0;
  const auto [stop, wrong] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (wrong == std::errc() && stop == text.data() + text.size() && count > 0) return count;
  return schema::fail(ErrorKind::usage, "is not a shard", "--shard " + shard,
                      "write the third of twenty as 3/20");
}

Result<void> read_shard(const std::string& text, CorpusRunOptions& options) {
  if (text.find('/') == std::string::npos)
    return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a shard", text), "--shard",
                        "write it as 3/20");
  const std::size_t slash = text.find('/');
  const auto shard = count_in(std::string_view(text).substr(0, slash), text);
  const auto shards = count_in(std::string_view(text).substr(slash + 1), text);
  TACTO_TRY(shard);
  TACTO_TRY(shards);
  if (*shard > *shards)
    return schema::fail(ErrorKind::usage, fmt::format("there are {} shards", *shards), "--shard " + text,
                        "count them from 1");
  options.shard = *shard;
  options.shards = *shards;
  return {};
}

Result<Report> run_run(CorpusRunOptions options, const std::optional<std::string>& shard) {
  if (shard) TACTO_TRY(read_shard(*shard, options));
  const cli::StopSignals signals;
  cli::Progress progress("recordings");
  const auto counts = run_corpus(
      options, [&](double fraction) { progress.update(fraction); }, [&] { return signals.stop_asked(); });
  TACTO_TRY(counts);
  Report report;
  report.add("recordings", counts->recordings).add("recordings_worked_on", counts->worked_on);
  report.add("results_made", counts->made);
  if (counts->failed > 0) report.add("of_these_failures", counts->failed);
  report.add("results_already_there", counts->present);
  if (counts->others > 0) report.add("results_made_by_another_run", counts->others);
  if (counts->removed > 0) report.add("removed_work_of_killed_runs", counts->removed);
  // A job whose exit code is 0 is complete for the programs that started it.
  if (counts->stopped) report.add("stopped", true).ends_with(ErrorKind::unsuitable);
  return report.add("next", fmt::format("tactograph corpus {} {}", counts->stopped ? "run" : "status",
                                        cli::shell_word(options.study)));
}

void declare_study(CLI::App& app, std::string& study) {
  app.add_option("STUDY", study, "Folder of the plan")->required();
}

void declare_verify(CLI::App& app, bool& verify) {
  app.add_flag(
      "--verify", verify,
      "Compare all results with their checksums, also files that are not newer than the checksum; 'status': "
      "also the recordings with those of 'init'");
}

cli::Action declare_run(CLI::App& app) {
  const auto options = std::make_shared<CorpusRunOptions>();
  const auto shard = std::make_shared<std::optional<std::string>>();
  declare_study(app, options->study);
  app.add_option("--jobs", options->jobs, "Number of recordings processed at the same time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--shard", *shard, "Only a part of the recordings: 3/20 is the third of twenty")
      ->type_name("I/N");
  declare_verify(app, options->verify);
  return [options, shard] { return run_run(*options, *shard); };
}

Report unit_row(const CorpusStatus& status, const CorpusUnitStatus& unit) {
  return Report()
      .add("recording", status.plan.recordings[unit.recording].path)
      .add("step", status.plan.steps[unit.step].step);
}

Result<Report> run_status(const std::string& study, bool verify, bool json) {
  const auto status = corpus_status(study, verify);
  TACTO_TRY(status);
  std::vector<Report> results, failures, missing;
  for (const CorpusUnitStatus& each : status->units) {
    Report row = unit_row(*status, each);
    if (each.unit.state == UnitState::failed)
      failures.push_back(std::move(row.add("because", each.unit.because)));
    else if (each.unit.state != UnitState::done)
      missing.push_back(std::move(row.add("damaged", each.unit.state == UnitState::damaged)));
    else if (json)
      results.push_back(std::move(row.add("folder", each.folder).add("warnings", each.unit.has_warnings)));
  }
  Report report;
  report.add("recordings", status->plan.recordings.size());
  report.add("done", status->done).add("failed", status->failed).add("missing", status->missing);
  if (status->warned > 0) report.add("results_with_warnings", status->warned);
  if (json) report.add("results", std::move(results));
  if (!failures.empty()) report.add("failures", std::move(failures));
  if (!missing.empty()) report.add("not_made", std::move(missing));
  std::vector<std::string> changed;
  for (const std::size_t i : status->changed) changed.push_back(status->plan.recordings[i].path);
  if (!changed.empty()) report.add("changed_since_init", std::move(changed));
  if (status->missing > 0) report.add("next", "tactograph corpus run " + cli::shell_word(study));
  if (status->failed + status->missing + status->changed.size() > 0) report.ends_with(ErrorKind::unsuitable);
  return report;
}

cli::Action declare_status(CLI::App& app) {
  const auto study = std::make_shared<std::string>();
  const auto verify = std::make_shared<bool>(false);
  declare_study(app, *study);
  declare_verify(app, *verify);
  CLI::App* const verb = app.get_parent();
  return [study, verify, verb] { return run_status(*study, *verify, verb->count("--json") > 0); };
}

Result<Report> run_pack(const CorpusPackOptions& options) {
  const cli::StopSignals signals;
  cli::Progress progress("recordings");
  const auto pack = pack_corpus(
      options, [&](double fraction) { progress.update(fraction); }, [&] { return signals.stop_asked(); });
  TACTO_TRY(pack);
  cli::Report report;
  report.add("recordings", pack->recordings).add("files", pack->files);
  if (pack->left_out > 0) report.add("left_out_damaged_recordings", pack->left_out);
  if (pack->renamed > 0) report.add("renamed_because_of_a_subjects_code", pack->renamed);
  report.add("subject_codes", options.with_subjects ? "are in the dataset" : "are removed");
  report.add("folder", options.output);
  return report.add("next", "cd " + cli::shell_word(options.output) + " && sha256sum -c --quiet SHA256SUMS");
}

cli::Action declare_pack(CLI::App& app) {
  const auto options = std::make_shared<CorpusPackOptions>();
  schema::Citation& citation = options->citation;
  app.add_option("STUDY", options->study, "Folder of the plan")->required();
  app.add_option("-o,--output", options->output, "Folder to write")->required();
  app.add_option("--title", citation.title,
                 "Title of the dataset; as the next four needed in order to cite it");
  app.add_option("--creator", citation.creators,
                 "A creator, if you like with ORCID: 'Doe, Jane <0000-0002-1825-0097>'; repeat it for more")
      ->expected(1)
      ->take_all();
  app.add_option("--publisher", citation.publisher, "Who publishes it: an archive, a university");
  app.add_option("--year", citation.year, "Year of publication");
  app.add_option("--licence,--license", citation.licence,
                 "CC0-1.0, CC-BY-4.0, CC-BY-SA-4.0, CC-BY-NC-4.0, ODbL-1.0, or the address of another one");
  app.add_flag("--with-subjects", options->with_subjects,
               "Keep the codes of subjects. Default: they are removed from sidecars, notes, names and "
               "tables; only codes that are the 'subject' of a recording are known");
  cli::declare_force(app, options->existing);
  return [options] { return run_pack(*options); };
}

struct WorkflowOptions {
  CorpusWorkflowOptions workflow;
  schema::Existing existing = schema::Existing::keep;
};

Result<Report> run_workflow(const WorkflowOptions& options) {
  const std::string& output = options.workflow.output;
  TACTO_TRY(schema::check_table_free(output, options.existing, is_workflow));
  const auto workflow = corpus_workflow(options.workflow);
  TACTO_TRY(workflow);
  schema::PendingFiles pending;
  TACTO_TRY(pending.write(output, workflow->text));
  TACTO_TRY(pending.commit(options.existing));
  const bool slurm = options.workflow.engine == WorkflowEngine::slurm;
  cli::Report report;
  report.add("recordings", workflow->recordings).add("shards", workflow->shards);
  report.add("shards_in_the_file", workflow->listed.size());
  report.add("estimated_work_s", workflow->work_s)
      .add("estimated_work_of_a_shard_s", workflow->work_s / static_cast<double>(workflow->shards))
      .add("estimated_from_recordings", workflow->read);
  report.add("files", std::vector<std::string>{output});
  return report.add("next", (slurm ? "sbatch " : "snakemake --cores 4 -s ") + cli::shell_word(output));
}

cli::Action declare_workflow(CLI::App& app) {
  const auto options = std::make_shared<WorkflowOptions>();
  CorpusWorkflowOptions& workflow = options->workflow;
  app.add_option("STUDY", workflow.study, "Folder of the plan")->required();
  cli::add_choice<WorkflowEngine>(
      app, "--engine", workflow.engine,
      {{"slurm", WorkflowEngine::slurm}, {"snakemake", WorkflowEngine::snakemake}},
      "An array of Slurm, or rules of Snakemake; each task runs 'corpus run --shard I/N'")
      ->required();
  app.add_option("-o,--output", workflow.output, "The file to write")->required();
  app.add_flag("--missing", workflow.missing,
               "Only shards in which a unit is missing or damaged: to resume after tasks were killed");
  app.add_option("--shards", workflow.shards,
                 "Number of shards; default: as many as have a minute of work each (estimated)")
      ->check(CLI::Range(std::size_t{1}, kMostShards));
  app.add_option("--account", workflow.account, "For Slurm, as its option")->type_name("NAME");
  app.add_option("--partition", workflow.partition, "For Slurm, as its option")->type_name("NAME");
  app.add_option("--time", workflow.time, "Time limit of a shard, as Slurm writes it: 30 (minutes), 2:00:00")
      ->type_name("LIMIT");
  app.add_option("--mem", workflow.memory, "Memory of a shard, as Slurm writes it: 500M, 4G")
      ->type_name("SIZE");
  cli::declare_force(app, options->existing);
  return [options] { return run_workflow(*options); };
}

constexpr cli::VerbPart kParts[] = {
    {"init", "Write the plan: recordings with their checksums, steps and options", declare_init},
    {"run", "Compute what is missing; after a recording that fails, the run goes on and notes it",
     declare_run},
    {"status", "What is done, missing or failed, and why; exit code 5 unless all is done", declare_status},
    {"workflow", "Write a file with which Slurm or Snakemake runs all shards on a cluster", declare_workflow},
    {"pack", "Write a dataset to give away: recordings, results, a table, checksums, an RO-Crate",
     declare_pack},
};

cli::Action declare_corpus(CLI::App& app) {
  return cli::declare_parts(app, kParts);
}

}  // namespace

const cli::Verb kCorpusVerb{
    "corpus", "Textures and descriptions of thousands of recordings, as a job that can be interrupted",
    "tactograph corpus init study --recordings 'raw/**/*.json' --spatial '--average'\n"
    "  tactograph corpus run study --jobs 2\n"
    "  tactograph corpus run study --shard 3/20\n"
    "  tactograph corpus status study\n"
    "  tactograph corpus workflow study --engine slurm --time 30 -o study.sbatch\n"
    "  tactograph corpus pack study -o published --title 'Oak and linen' --creator 'Doe, Jane' --publisher "
    "Zenodo --year 2026 --licence CC-BY-4.0",
    declare_corpus};

}  // namespace tacto::analysis
