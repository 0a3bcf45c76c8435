// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/corpus_steps.hpp"

#include <algorithm>
#include <filesystem>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/texture/description.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/version.hpp"
#include "spatial/job/description_options.hpp"
#include "spatial/job/spatial_recording.hpp"
#include "spatial/job/texture_names.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::Result;

constexpr const char* kNotHere[] = {"recording", "--output",  "--force",     "--jobs",   "--list",
                                    "--mix",     "--quality", "--max-error", "--explain"};

Result<void> parse(CLI::App& app, const schema::CorpusStep& step) try {
  app.set_help_flag();
  app.parse(step.options);
  return {};
} catch (const CLI::Error& wrong) {
  return schema::fail(ErrorKind::usage, wrong.what(), "--" + step.step + " '" + step.options + "'",
                      "'tactograph " + step.step + " --help' explains the options");
}

Result<void> parse_spatial(const schema::CorpusStep& step, spatial::SpatialOptions& options) {
  CLI::App app;
  spatial::declare_spatial(app, options);
  for (const char* name : kNotHere) app.remove_option(app.get_option(name));
  TACTO_TRY(parse(app, step));
  const auto texture = spatial::texture_options(options);
  return texture ? Result<void>{} : schema::forward_error(texture);
}

Result<void> parse_description(const schema::CorpusStep& step, spatial::DescriptionOptions& options) {
  CLI::App app;
  spatial::declare_description(app, options);
  return parse(app, step);
}

// By name, as `describe FOLDER`.
Result<std::vector<std::string>> textures_in(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
    if (at->path().string().ends_with(".texture.json")) paths.push_back(at->path().string());
  if (failed) return schema::fail(ErrorKind::not_found, "cannot be listed: " + failed.message(), folder);
  std::ranges::sort(paths);
  return paths;
}

Result<schema::Description> described(const spatial::DescriptionOptions& options, const std::string& path) {
  const auto texture = schema::read_texture(path);
  TACTO_TRY(texture);
  auto description = spatial::describe(*texture, options);
  if (!description) {
    if (description.error().where.empty()) description.error().where = path;
    return description;
  }
  description->texture = fs::path(schema::stem_of(path, ".texture")).filename().string();
  return description;
}

}  // namespace

Result<CorpusSteps> parse_steps(const std::vector<schema::CorpusStep>& steps) {
  CorpusSteps parsed;
  for (const schema::CorpusStep& step : steps)
    TACTO_TRY(step.step == "spatial" ? parse_spatial(step, parsed.spatial)
                                     : parse_description(step, parsed.description));
  parsed.spatial.sync = schema::Sync::by_caller;
  return parsed;
}

Result<std::vector<std::string>> make_textures(const spatial::SpatialOptions& options,
                                               const std::string& recording, const std::string& folder) {
  const auto stems = spatial::texture_stems({recording}, folder + "/");
  TACTO_TRY(stems);
  const auto outcome = spatial::spatial_recording(options, recording, stems->front(), [](double) {});
  TACTO_TRY(outcome.report);
  std::vector<std::string> warnings;
  for (const cli::Warning& warning : outcome.warnings) warnings.push_back(cli::sentence(warning));
  if (outcome.too_short.any()) warnings.push_back("too short: " + words_of(outcome.too_short));
  return warnings;
}

Result<void> make_descriptions(const spatial::DescriptionOptions& options, const std::string& recording,
                               const std::string& textures, const std::string& folder) {
  const auto paths = textures_in(textures);
  TACTO_TRY(paths);
  schema::DescriptionFile all;
  for (const std::string& path : *paths) {
    auto description = described(options, path);
    TACTO_TRY(description);
    all.textures.push_back(std::move(*description));
  }
  all.created = schema::creation_time();
  all.creator = kCreator;
  const auto text = schema::descriptions_json(all);
  TACTO_TRY(text);
  const std::string name = fs::path(schema::stem_of(recording, "")).filename().string();
  schema::PendingFiles pending;
  TACTO_TRY(pending.write((fs::path(folder) / (name + ".descriptions.json")).string(), *text));
  return pending.commit(schema::Existing::keep, schema::Sync::by_caller);
}

}  // namespace tacto::analysis
