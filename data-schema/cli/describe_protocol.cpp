// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/experiment/protocol.hpp"

namespace tacto::schema {

Result<cli::Report> describe_protocol(const std::string& path) {
  const auto protocol = read_protocol(path);
  TACTO_TRY(protocol);
  warn_of_unknown(path, *protocol);
  cli::Report report = report_of(FileKind::protocol, path, "");
  report.add("task", word_of(protocol->task)).add("question", question_of(*protocol));
  if (protocol->task == Task::two_interval)
    report.add("standard_period_m", protocol->standard.period_m)
        .add("standard_amplitude_m", protocol->standard.amplitude_m)
        .add("levels", protocol->levels.size())
        .add("method", word_of(protocol->method));
  else
    report.add("standards", protocol->standards.size());
  if (protocol->task == Task::identification)
    report.add("comparisons", protocol->comparisons.size()).add("conditions", protocol->conditions);
  if (protocol->task == Task::adjustment) report.add("goal", word_of(protocol->goal));
  report.add("repetitions", protocol->repetitions);
  std::vector<std::string> languages;
  for (const auto& [language, texts] : protocol->texts) languages.push_back(language);
  report.add("languages", languages);
  report.add("participants", protocol->participants).add("seed", protocol->seed);
  add_text(report, "notes", protocol->notes);
  return report;
}

// Without the codes: who looks at a folder is not to learn them.
Result<cli::Report> describe_protocol_key(const std::string& path) {
  const auto key = read_protocol_key(path);
  TACTO_TRY(key);
  return report_of(FileKind::protocol_key, path, "").add("stimuli", key->stimuli.size());
}

}  // namespace tacto::schema
