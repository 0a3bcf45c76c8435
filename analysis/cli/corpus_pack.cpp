// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph corpus pack: a corpus as a dataset to give away.
#include "analysis/corpus/corpus_pack.hpp"

#include <memory>

#include "analysis/cli/corpus_parts.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {
namespace {

schema::Result<cli::Report> run_pack(const CorpusPackOptions& options) {
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

}  // namespace

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
               "tables; only codes "
               "that are the 'subject' of a recording are known");
  cli::declare_force(app, options->existing);
  return [options] { return run_pack(*options); };
}

}  // namespace tacto::analysis
