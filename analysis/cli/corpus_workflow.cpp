// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph corpus workflow: a corpus as a job of a cluster.
#include "analysis/corpus/corpus_workflow.hpp"

#include <memory>

#include "analysis/cli/corpus_parts.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {
namespace {

struct WorkflowOptions {
  CorpusWorkflowOptions workflow;
  schema::Existing existing = schema::Existing::keep;
};

schema::Result<cli::Report> run_workflow(const WorkflowOptions& options) {
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

}  // namespace

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

}  // namespace tacto::analysis
