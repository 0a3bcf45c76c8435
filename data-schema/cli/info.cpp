// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/cli/verbs.hpp"

namespace tacto::schema {
namespace {

struct InfoOptions {
  std::vector<std::string> names;
};

Result<cli::Report> describe(const StoredFile& file) {
  switch (file.kind) {
    case FileKind::recording:
      return describe_recording(file.path);
    case FileKind::texture:
      return describe_texture(file.path);
    case FileKind::transducer:
      return describe_transducer(file.path);
    case FileKind::spectrogram:
      return describe_spectrogram(file.path);
    case FileKind::formants:
      return describe_formants(file.path);
    case FileKind::descriptions:
      return describe_descriptions(file.path);
    case FileKind::calibration:
      return describe_calibration(file.path);
    case FileKind::scene:
      return describe_scene(file.path);
    case FileKind::session:
      return describe_session(file.path);
    case FileKind::results:
      return describe_results(file.path);
    case FileKind::trade:
      return describe_trade(file.path);
    case FileKind::device:
      return describe_device(file.path);
    case FileKind::hand:
      return describe_hand(file.path);
    case FileKind::session_table:
      return describe_session_table(file.path);
    case FileKind::height_map:
      return describe_height_map(file.path);
    case FileKind::mesh:
      return describe_mesh(file.path);
    case FileKind::volume:
      return describe_volume(file.path);
    case FileKind::corpus:
      return describe_corpus(file.path);
    case FileKind::protocol:
      return describe_protocol(file.path);
    case FileKind::protocol_key:
      return describe_protocol_key(file.path);
    case FileKind::wiring:
      return describe_wiring(file.path);
  }
  return fail(ErrorKind::internal, "this kind of file cannot be described", file.path);
}

// A stem can name several files: the first is described, the others are listed.
Result<cli::Report> describe_name(const std::string& name) {
  const auto files = stored_files(name);
  TACTO_TRY(files);
  auto report = describe(files->front());
  if (!report || files->size() == 1) return report;
  std::vector<std::string> others;
  for (std::size_t i = 1; i < files->size(); ++i) others.push_back((*files)[i].path);
  report->add("also", std::move(others));
  return report;
}

Result<cli::Report> run_info(const InfoOptions& options) {
  if (options.names.size() == 1) return describe_name(options.names.front());
  std::vector<cli::Report> reports;
  for (const std::string& name : options.names) {
    auto report = describe_name(name);
    if (!report) return report;
    reports.push_back(std::move(*report));
  }
  cli::Report all;
  all.add("files", std::move(reports));
  return all;
}

cli::Action declare_info(CLI::App& app) {
  auto options = std::make_shared<InfoOptions>();
  app.add_option("FILE", options->names,
                 "Recordings, textures, scenes, devices ...: by stem, in full, or a preset's name")
      ->required();
  cli::explain_strokes(app);
  return [options] { return run_info(*options); };
}

}  // namespace

const cli::Verb kInfoVerb{
    "info", "Describe the contents of a file: channels, units, ranges, gaps, calibration, origin",
    "tactograph info oak\n  tactograph info oak.texture.json wiertlewski2011 --json", declare_info};

}  // namespace tacto::schema
