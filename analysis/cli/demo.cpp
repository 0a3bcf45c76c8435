// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <sstream>

#include "analysis/cli/stopped.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "capture/cli/verbs.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/report/terminal.hpp"
#include "data-schema/results/results.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/sim/physics/paper_surfaces.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/spectrogram/spectrogram.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::Result;

constexpr std::string_view kDemoNotes = "made by tactograph demo";

/// A command of the demo. In its words {stem} is the file's name in the demo's folder, {surface} a letter.
struct DemoCommand {
  const cli::Verb* verb;
  std::string_view arguments;
  std::string_view purpose;
};

// The page shows these commands, and they are run as it shows them, in this order, for each surface. At 0.5
// mm/N no surface needs more than the transducer's 5 V.
constexpr DemoCommand kOfEachSurface[] = {
    {&capture::kRecordVerb,
     "-d sim:surface={surface},speed=50mm/s,seed=1 --time 1s --notes {notes} -o {stem}",
     "A finger strokes the surface on the transducer: force and position over time, as the device's "
     "converter "
     "gives them."},
    {&spatial::kSpatialVerb, "{stem} -o {stem} --stroke 1",
     "The first stroke becomes a texture, force against position: 15-500 Hz, divided by the sensor's "
     "response, piecewise cubic Hermite, 1 um grid."},
    {&spatial::kSpectrogramVerb, "{stem} -o {stem}.png -o {stem}.nc",
     "The spatial spectrogram of the texture, as a picture and as data."},
    {&kFidelityVerb, "{stem} --speed 25mm/s --gain 0.5mm/N -o {stem}.results.json",
     "The texture is played at half the speed, through the inverse of the transducer's model. Trays that are "
     "integrated from their equations of motion, independently of that inverse, move under the drive; their "
     "displacement is compared with the target. The first tray is the model's, the others deviate from it."},
};
// A recording to work on, of four strokes, on the surface whose own period (0.5 mm: 2 /mm) is within the
// valid band at this speed, 1.5 to 10 /mm. The periods of B and C (1.5 and 3 mm) are below it.
constexpr DemoCommand kToWorkOn = {
    &capture::kRecordVerb, "-d sim:surface=E,speed=50mm/s,seed=1 --time 3.8s --notes {notes} -o {stem}",
    "A recording of four strokes to work on, which the guide uses."};
constexpr std::string_view kFingerName = "finger";

struct RunCommand {
  std::string line;     ///< as a user types it
  std::string printed;  ///< what it prints
};

struct ShownSurface {
  std::string name, description;
  std::vector<RunCommand> commands;
  std::string spectrogram_svg;
  schema::Results fidelity;
};

std::vector<std::string> demo_words(const DemoCommand& command, const std::string& stem,
                                    const std::string& surface) {
  std::vector<std::string> words;
  std::istringstream text{std::string(command.arguments)};
  for (std::string word; text >> word;)
    words.push_back(fmt::format(fmt::runtime(word), fmt::arg("stem", stem), fmt::arg("surface", surface),
                                fmt::arg("notes", kDemoNotes)));
  return words;
}

Result<RunCommand> run_of(const DemoCommand& command, const std::string& stem,
                          const std::string& surface = "") {
  const auto words = demo_words(command, stem, surface);
  RunCommand run{fmt::format("tactograph {}", command.verb->name), {}};
  for (const std::string& word : words) run.line += " " + cli::shell_word(word);
  const auto report = cli::run_verb(*command.verb, words);
  if (cli::StopSignals::stop_asked())
    end_as_stopped();  // a recording that was cut short is no error of 'record'
  TACTO_TRY(report);
  run.printed = report->for_people();
  return run;
}

// The recording, by which an earlier demo is known, is removed last.
constexpr const char* kDemoEndings[] = {".texture.json", ".texture.wav",  ".nc",  ".png",
                                        ".results.json", ".events.jsonl", ".wav", ".json"};

bool is_of_demo(const std::string& stem) {
  const auto recording = schema::open_recording(stem);
  return recording && recording->header.notes == kDemoNotes;
}

Result<void> not_of_demo(const std::string& path) {
  return schema::fail(schema::ErrorKind::usage, "exists, and was not made by an earlier demo", path,
                      "choose another folder with -o");
}

// Removes the files of an earlier demo; refuses other files of these names, before it removes any.
Result<void> clear_earlier(const std::string& folder, const std::string& page) {
  std::vector<std::string> stems = {fmt::format("{}/{}", folder, kFingerName)};
  for (const auto& surface : firmware_host::paper_surfaces())
    stems.push_back(fmt::format("{}/{}", folder, surface.name));
  std::error_code ignored;
  if (fs::exists(page, ignored) && !is_of_demo(stems.front())) return not_of_demo(page);
  for (const std::string& stem : stems) {
    if (is_of_demo(stem)) continue;
    for (const char* ending : kDemoEndings)
      if (fs::exists(stem + ending, ignored)) return not_of_demo(stem + ending);
  }
  for (const std::string& stem : stems)
    for (const char* ending : kDemoEndings) fs::remove(stem + ending, ignored);
  return {};
}

std::string commands_html(std::span<const RunCommand> commands) {
  std::string lines, printed;
  for (const RunCommand& command : commands) {
    lines += escaped(command.line) + "\n";
    printed += fmt::format("$ {}\n{}\n", escaped(command.line), escaped(command.printed));
  }
  return fmt::format("<pre>{}</pre>\n{}", lines,
                     folded("What these commands print", fmt::format("<pre>{}</pre>\n", printed)));
}

Result<std::string> section_html(const ShownSurface& s) {
  const auto pictures = pictures_html(s.fidelity.pictures, s.fidelity.simulated);
  TACTO_TRY(pictures);
  return fmt::format(
      "<h2>Surface {}: {}</h2>\n{}{}{}{}", escaped(s.name), escaped(s.description), commands_html(s.commands),
      inline_svg(s.spectrogram_svg, fmt::format("Spatial spectrogram of surface {}, simulated", s.name)),
      figures_html(s.fidelity.figures), *pictures);
}

Result<std::string> page_html(const std::vector<ShownSurface>& surfaces, const RunCommand& to_work_on) {
  std::string steps;
  for (const DemoCommand& command : kOfEachSurface)
    steps += fmt::format("<li><code>{}</code>: {}</li>\n", command.verb->name, escaped(command.purpose));
  std::string body = fmt::format(
      "<h1>tactograph: five surfaces, recorded and played back</h1>\n{}{}<p>The surfaces are those of "
      "Wiertlewski, Lozada and Hayward (2011). For each of them:</p>\n<ol>\n{}</ol>\n",
      simulated_box(fmt::format("by the emulated device of {}", kCreator)),
      answer(fmt::format("These {} commands made everything on this page, in this order; each may be typed "
                         "in a shell.",
                         std::size(kOfEachSurface) * surfaces.size() + 1)),
      steps);
  body += html_table(surfaces, {{"surface", &ShownSurface::name},
                                {"made by", &ShownSurface::description},
                                {"played back", [](const ShownSurface& s) {
                                   return s.fidelity.figures.empty()
                                              ? ""
                                              : s.fidelity.figures.front().name + ": " +
                                                    s.fidelity.figures.front().value;
                                 }}});
  for (const ShownSurface& surface : surfaces) {
    const auto section = section_html(surface);
    TACTO_TRY(section);
    body += *section;
  }
  body += fmt::format("<h2>To work on</h2>\n<p>{}</p>\n{}", escaped(kToWorkOn.purpose),
                      commands_html({&to_work_on, 1}));
  return html_document("tactograph demo (simulated)", body);
}

Result<ShownSurface> shown_surface(const firmware_host::PaperSurface& surface, const std::string& folder) {
  ShownSurface shown{std::string(1, surface.name), std::string(surface.description), {}, {}, {}};
  const std::string stem = folder + "/" + shown.name;
  for (const DemoCommand& command : kOfEachSurface) {
    auto run = run_of(command, stem, shown.name);
    TACTO_TRY(run);
    shown.commands.push_back(std::move(*run));
  }
  auto texture = schema::read_texture(stem);
  TACTO_TRY(texture);
  auto spectrogram = spatial::spatial_spectrogram(*texture, {});
  TACTO_TRY(spectrogram);
  spectrogram->name = shown.name;
  texture->simulated = kSimulatedOnPage;
  auto svg = spatial::to_page_svg(spatial::SpectrogramFigure({{&*texture, &*spectrogram}}));
  TACTO_TRY(svg);
  shown.spectrogram_svg = std::move(*svg);
  auto results = schema::read_results(stem + ".results.json");
  TACTO_TRY(results);
  shown.fidelity = std::move(*results);
  return shown;
}

Result<cli::Report> demonstrate(const std::string& folder) {
  const std::string page = folder + "/index.html", finger = fmt::format("{}/{}", folder, kFingerName);
  TACTO_TRY(clear_earlier(folder, page));
  std::vector<ShownSurface> surfaces;
  std::vector<std::string> lines;
  for (const auto& surface : firmware_host::paper_surfaces()) {
    auto shown = shown_surface(surface, folder);
    TACTO_TRY(shown);
    for (const RunCommand& command : shown->commands) lines.push_back(command.line);
    surfaces.push_back(std::move(*shown));
  }
  const auto to_work_on = run_of(kToWorkOn, finger);
  TACTO_TRY(to_work_on);
  lines.push_back(to_work_on->line);
  const auto html = page_html(surfaces, *to_work_on);
  TACTO_TRY(html);
  schema::PendingFiles files;
  TACTO_TRY(files.write(page, *html));
  TACTO_TRY(files.commit());
  cli::Report report;
  report.add("simulated", fmt::format("by the emulated device of {}", kCreator));
  report.add("commands", std::move(lines)).add("page", page).add("recording", finger);
  report.add("next",
             fmt::format("open {} in a browser; then: tactograph spatial {} --list (analysis/GUIDE.md)", page,
                         cli::shell_word(finger)));
  return report;
}

cli::Action declare_demo(CLI::App& app) {
  auto folder = std::make_shared<std::string>("demo");
  app.add_option("-o,--output", *folder, "Output folder; the files of an earlier demo there are replaced")
      ->type_name("DIR");
  return [folder] { return demonstrate(*folder); };
}

}  // namespace

const cli::Verb kDemoVerb{"demo",
                          "Run the main verbs on five emulated surfaces, as commands that the page shows "
                          "with what they made; and make a recording to work on",
                          "tactograph demo -o demo", declare_demo};

}  // namespace tacto::analysis
