// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "capture/cli/verbs.hpp"
#include "capture/record/live_view.hpp"
#include "capture/record/record.hpp"
#include "capture/record/take_name.hpp"
#include "capture/table/text_encoding.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/command/terminal_keys.hpp"
#include "data-schema/recording/live_recording.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/report/pace.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/report/report_text.hpp"
#include "data-schema/report/terminal.hpp"
#include "data-schema/report/warnings.hpp"
#include "firmware-host/open_device.hpp"
#include "firmware-host/sim/device/sim_parameters.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;
using schema::Result;

struct RecordOptions {
  std::string device = "usb:", pattern;
  RecordRequest request;
  bool allow_gaps = false, no_calibration = false, commands = false;
  std::string calibration;
  std::optional<double> stale_after_s;
};

void declare_options(CLI::App& app, RecordOptions& options) {
  RecordRequest& request = options.request;
  app.add_option("-d,--device", options.device,
                 "The device; default: usb:, the only one on USB; usb:serial=XYZ, tty:, or "
                 "sim:surface=C,speed=50mm/s,seed=1 (all keys: tactograph help sim), or replay:NAME");
  CLI::Option* const name =
      app.add_option("-o,--output", request.name,
                     "Name of the recording: NAME.wav and NAME.json; existing files are not replaced");
  app.add_option("--template", options.pattern,
                 "Instead of a name: a pattern such as {subject}_{surface}_{finger}_{take}; {take} counts up")
      ->excludes(name);
  cli::add_quantity(app, "--time", request.time_s, Dimension::time,
                    "Duration; default: until --strokes are made, or Ctrl-C");
  app.add_option("--strokes", request.strokes, "End after this number of strokes")->check(cli::from_one());
  app.add_flag("--allow-gaps", options.allow_gaps, "Exit code 0 even if frames are lost");
  app.add_option("--calibration", options.calibration,
                 "Calibration file of the device, if not the one that 'tactograph calibrate' stores");
  app.add_flag("--no-calibration", options.no_calibration, "Use the nominal scales of the device only");
  cli::add_quantity(
      app, "--stale-after", options.stale_after_s, Dimension::time,
      "Age from which a calibration causes a warning; default: " + fmt::format("{} days", kStaleAfterDays));
  app.add_option("--subject", request.subject, "A code for the person, never a name");
  app.add_option("--finger", request.finger, "Finger, or object that slides instead of one");
  app.add_option("--surface", request.surface, "Surface that is touched; default: as the device reports");
  app.add_option("--notes", request.notes, "Notes in free text");
  app.add_flag(
      "--commands", options.commands,
      "Another program steers the recording by lines on stdin: 'mark LABEL', 'stop'; the end of the input "
      "is 'stop', too. Answers are lines of JSON on stdout");
}

std::string footer_text() {
  return fmt::format(
      "\nThe emulated device (sim:) and its keys: tactograph help sim.\n"
      "During a recording, Ctrl-C or q ends and stores it, m or SIGUSR1 sets a mark. After a crash or a "
      "power "
      "cut, 'tactograph recover NAME' restores the recording without its last {} ({} after a power cut with "
      "a busy disk).",
      schema::for_people(schema::kMostLost_s, schema::Dimension::time),
      schema::for_people(schema::kMostLostBusy_s, schema::Dimension::time));
}

cli::Report row_of(const schema::Channel& channel, const schema::Statistics& statistics) {
  cli::Report row;
  row.add("name", channel.name).add("unit", channel.unit);
  row.add("smallest", statistics.min()).add("largest", statistics.max()).add("rms", statistics.rms());
  if (!channel.calibrated.empty()) row.add("calibrated", channel.calibrated);
  return row.add("from", channel.source);
}

std::vector<cli::Report> rows_of(const Recorded& recorded) {
  std::vector<cli::Report> rows;
  for (std::size_t i = 0; i < recorded.statistics.size(); ++i)
    rows.push_back(row_of(recorded.recording.header.channels[i], recorded.statistics[i]));
  return rows;
}

constexpr const char* kRealTime = "with paced=1 it runs in real time";

// A device that does not run in real time would fill the disk before the user can press Ctrl-C.
Result<void> check_end(const firmware_host::DeviceToRecord& opened, const RecordOptions& options) {
  const RecordRequest& request = options.request;
  if (opened.device->is_real_time() || opened.ends_by_itself || request.time_s) return {};
  if (request.strokes == 0)
    return schema::fail(
        schema::ErrorKind::usage,
        "this device runs faster than real time and would fill the disk: give the recording an end",
        options.device, fmt::format("add --time 2s or --strokes 2; {}", kRealTime));
  if (request.strokes <= opened.strokes.value_or(request.strokes)) return {};
  return schema::fail(schema::ErrorKind::usage,
                      fmt::format("the device makes {} strokes, but the recording would end after {}",
                                  *opened.strokes, request.strokes),
                      options.device, "use fewer --strokes, let the device make more, or add --time 2s");
}

// The folder of the recording if it has to be made, else empty.
std::string missing_folder(const std::string& name) {
  const std::string folder = std::filesystem::path(name).parent_path().string();
  std::error_code ignored;
  return folder.empty() || std::filesystem::is_directory(folder, ignored) ? "" : folder;
}

cli::Report report_on(const Recorded& recorded, const firmware_host::Device& device, const cli::Pace& pace,
                      const std::string& made_folder) {
  const schema::RecordingHeader& header = recorded.recording.header;
  const std::string& stem = recorded.recording.stem;
  cli::Report report;
  report.add("device", header.device).add("simulated", header.simulated).add("surface", header.surface);
  report.add("frames", header.frames).add("sample_rate_hz", header.sample_rate_hz);
  report.add("duration_s", schema::duration_s(header));
  if (!device.is_real_time()) pace.add_to(report, schema::duration_s(header));
  report.add("clipped_samples", recorded.counts.clipped).add("lost_frames", recorded.counts.lost_frames);
  report.add("gaps", header.gaps.size()).add("marks", header.marks.size());
  report.add("channels", rows_of(recorded));
  schema::add_strokes(report, header);
  if (!header.ended.empty()) report.add("ended", header.ended);
  if (!header.warnings.empty()) report.add("warnings", header.warnings);
  report.add("files", std::vector{stem + ".wav", stem + ".json"});
  if (!made_folder.empty()) report.add("made_folder", made_folder);
  return report.add("next", fmt::format("tactograph spatial {0} -o {0}", cli::shell_word(stem)));
}

Result<std::string> chosen_name(const RecordOptions& options) {
  if (options.pattern.empty() && options.request.name.empty())
    return schema::fail(schema::ErrorKind::usage, "the name of the recording is missing", {},
                        "give -o NAME, or --template '{subject}_{surface}_{take}'");
  if (options.pattern.empty()) return options.request.name;
  const RecordRequest& request = options.request;
  return name_of_take(
      options.pattern,
      {{"subject", request.subject}, {"surface", request.surface}, {"finger", request.finger}});
}

std::size_t terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1U : 79;
}

constexpr std::size_t kLongestLine = 1000;  // a pipe takes lines of up to 4096 bytes whole

bool ready(int file, short events) {
  pollfd waiting{file, events, 0};
  return poll(&waiting, 1, 0) == 1;
}

void print(const cli::Report& event) {
  const std::string line = cli::json_line(event);
  if (ready(STDOUT_FILENO, POLLOUT)) std::ignore = ::write(STDOUT_FILENO, line.data(), line.size());
}

void refuse(const char* why) {
  print(cli::Report().add("event", "error").add("what", why).add("remedy", "write 'mark LABEL' or 'stop'"));
}

// The commands by which another program steers a recording: lines on stdin, answers as lines of JSON on
// stdout. Commands: "mark LABEL", "stop". The end of the input is "stop", too, so that a recording ends with
// the program that steers it. A line that is no command is answered by an event "error" and changes nothing.
// Answers never wait for their reader: if the pipe is full, they are dropped. One thread.
class CommandLines {
 public:
  // Reads what has come, without waiting. Returns true from the command "stop" on, but not at the first
  // call.
  bool stopped() {
    if (!std::exchange(begun_, true)) {  // also a program that stops at once gets a recording, of one block
      print(cli::Report().add("event", "recording"));
      return false;
    }
    char bytes[4096];
    while (!stopped_ && ready(STDIN_FILENO, POLLIN)) {
      const auto got = ::read(STDIN_FILENO, bytes, sizeof bytes);
      if (got <= 0) return stopped_ = true;
      input_.append(bytes, static_cast<std::size_t>(got));
      for (auto end = input_.find('\n'); end != input_.npos && !stopped_; end = input_.find('\n')) {
        const std::string line = input_.substr(0, end);
        input_.erase(0, end + 1);
        if (std::exchange(too_long_, false)) continue;
        obey(line.ends_with('\r') ? line.substr(0, line.size() - 1) : line);
      }
      if (input_.size() <= kLongestLine) continue;
      if (!std::exchange(too_long_, true)) refuse("this line is longer than 1000 bytes");
      input_.clear();
    }
    return stopped_;
  }

  // The labels of the marks since the last call.
  std::vector<std::string> take_labels() { return std::exchange(labels_, {}); }

  // Answers a mark. `time_s`: since the first frame, lost frames included.
  static void answer(const schema::Mark& mark, double time_s) {
    print(cli::Report()
              .add("event", "mark")
              .add("frame", mark.frame)
              .add("time_s", time_s)
              .add("label", mark.label));
  }

 private:
  void obey(const std::string& line) {
    if (line == "stop") {
      stopped_ = true;
    } else if (!line.starts_with("mark ") || line.size() == 5) {
      refuse("this line is no command");
    } else if (!is_utf8(line)) {
      refuse("the label is not UTF-8");
    } else {
      labels_.push_back(line.substr(5));
    }
  }

  std::string input_;
  std::vector<std::string> labels_;
  bool begun_ = false, stopped_ = false, too_long_ = false;  // the rest of a line is passed over
};

constexpr int kBar = 8;

// The largest value of a channel as a fraction of its converter's range.
double part_of_range(const schema::Channel& channel, const ChannelLevel& level) {
  const double up = channel.range_max && *channel.range_max > 0 ? level.largest / *channel.range_max : 0;
  const double down = channel.range_min && *channel.range_min < 0 ? level.smallest / *channel.range_min : 0;
  return std::clamp(std::max(up, down), 0.0, 1.0);
}

bool has_range(const schema::Channel& channel) {
  return channel.range_max || channel.range_min;
}

std::string bars(const LiveView& view, const schema::RecordingHeader& header) {
  std::string text;
  for (std::size_t i = 0; i < view.levels.size(); ++i) {
    if (!has_range(header.channels[i])) continue;
    const auto full =
        static_cast<std::size_t>(std::lround(kBar * part_of_range(header.channels[i], view.levels[i])));
    text += fmt::format("{} [{}{}]  ", header.channels[i].name, std::string(full, '#'),
                        std::string(kBar - full, '-'));
  }
  return text;
}

// The same as numbers, for lines too short for bars.
std::string peaks(const LiveView& view, const schema::RecordingHeader& header) {
  std::string text;
  for (std::size_t i = 0; i < view.levels.size(); ++i)
    if (has_range(header.channels[i]))
      text += fmt::format("{}{:.0f}", text.empty() ? "peaks " : "/",
                          100 * part_of_range(header.channels[i], view.levels[i]));
  return text.empty() ? text : text + " %  ";
}

// Clipping is shown near the beginning of the line, because it cannot be corrected afterwards.
std::string clipping(const LiveView& view, const schema::RecordingHeader& header) {
  std::string text;
  for (std::size_t i = 0; i < view.levels.size(); ++i)
    if (view.levels[i].clipped) text += (text.empty() ? "CLIP " : ", ") + header.channels[i].name;
  return text.empty() ? text : text + "  ";
}

std::string judged(double value, const schema::TargetBand& band, const char* more, const char* less) {
  return band.holds(value) ? "ok" : value < band.middle ? more : less;
}

std::string finger(const LiveView& view) {
  std::string text;
  if (view.speed_mps)
    text += fmt::format("{:3.0f} mm/s {}  ", *view.speed_mps * 1e3,
                        judged(*view.speed_mps, schema::kTargetSpeed_mps, "FASTER", "SLOWER"));
  if (view.normal_n)
    text += fmt::format("load {:.2f} N {}  ", *view.normal_n,
                        judged(*view.normal_n, schema::kTargetLoad_n, "MORE", "LESS"));
  return text;
}

// The state of a running recording as one line of a terminal: "12.3 s  CLIP net_force   48 mm/s ok  load 0.90
// N LESS  3 strokes  0 lost  normal_force [###-----] net_force [########]  12.4 GB left": the clipped
// channels; speed and load compared with their target bands, with the correction; levels as fractions of the
// converter's range ("peaks 37/100 %" if there is no room for bars: 80 columns). Without colours, for every
// terminal; at most one line of `columns` characters.
std::string live_line(const LiveView& view, const schema::RecordingHeader& header, std::size_t columns) {
  std::string line = fmt::format("{:.1f} s  ", view.time_s);
  line += clipping(view, header);
  line += finger(view);
  line += fmt::format("{} strokes  {} lost  ", view.strokes, view.lost_frames);
  const std::string levels = bars(view, header);
  line += line.size() + levels.size() <= columns ? levels : peaks(view, header);
  line += fmt::format("{:.1f} GB left  ", static_cast<double>(view.disk_left_bytes) / 1e9);
  return line.substr(0, columns);
}

// The user interface of a recording: signals and keys are the input, a line of figures is the output.
class Console {
 public:
  explicit Console(bool commands) {
    if (commands)
      lines_.emplace();
    else
      keys_.emplace();
  }
  RecordHooks hooks() {
    RecordHooks hooks;
    hooks.stop = [this] { return look_at_input(), stopped_ || signals_.stop_asked(); };
    hooks.new_marks = [this] {
      std::vector<std::string> labels(signals_.take_marks() + std::exchange(marks_, 0), "mark");
      if (lines_) std::ranges::move(lines_->take_labels(), std::back_inserter(labels));
      return labels;
    };
    if (lines_) hooks.marked = &CommandLines::answer;
    if (isatty(STDERR_FILENO) == 1)
      hooks.view = [](const LiveView& view, const schema::RecordingHeader& header) {
        cli::write_message(fmt::format("\r\033[K{}", live_line(view, header, terminal_columns())));
        std::fflush(stderr);
      };
    else
      hooks.progress = [this](double fraction) { progress_.update(fraction); };
    return hooks;
  }
  ~Console() {
    if (isatty(STDERR_FILENO) == 1) cli::write_message("\r\033[K");
  }

 private:
  void look_at_input() {
    if (lines_) stopped_ = lines_->stopped();
    for (char key = keys_ ? keys_->next() : '\0'; key != 0; key = keys_->next()) {
      stopped_ = stopped_ || key == 'q';
      marks_ += key == 'm' ? 1 : 0;
    }
  }

  cli::StopSignals signals_;
  std::optional<cli::TerminalKeys> keys_;  // one of these two
  std::optional<CommandLines> lines_;
  cli::Progress progress_{"recording"};
  bool stopped_ = false;
  std::size_t marks_ = 0;
};

Result<cli::Report> run_record(const RecordOptions& options) {
  RecordRequest request = options.request;
  auto name = chosen_name(options);
  TACTO_TRY(name);
  request.name = std::move(*name);
  request.stale_after_s = options.stale_after_s.value_or(kStaleAfter_s);
  const auto opened = firmware_host::open_device_to_record(options.device);
  TACTO_TRY(opened);
  TACTO_TRY(check_end(*opened, options));
  const auto& device = opened->device;
  if (!options.no_calibration) {
    auto calibration = calibration_of(device->capabilities().serial, options.calibration);
    TACTO_TRY(calibration);
    request.calibration = std::move(*calibration);
  }
  const std::string made_folder = missing_folder(request.name);
  const cli::Pace pace;
  const Result<Recorded> recorded = [&] {
    Console console(options.commands);
    return record(*device, request, console.hooks());
  }();
  TACTO_TRY(recorded);
  cli::warn_grouped(recorded->recording.header.warnings);
  cli::Report report = report_on(*recorded, *device, pace, made_folder);
  const bool gaps = !recorded->recording.header.gaps.empty() || recorded->counts.lost_frames > 0;
  if (gaps && !options.allow_gaps) report.ends_with(schema::ErrorKind::device);
  if (recorded->ended_by && recorded->recording.header.ended.empty())
    cli::warn("the recording is complete, but the device did not stop: " +
              schema::message(*recorded->ended_by));
  if (recorded->ended_by) report.ends_with(recorded->ended_by->kind);
  return report;
}

cli::Action declare_record(CLI::App& app) {
  auto options = std::make_shared<RecordOptions>();
  declare_options(app, *options);
  app.footer(app.get_footer() + "\n" + footer_text());
  cli::explain_strokes(app);
  return [options] { return run_record(*options); };
}

}  // namespace

const cli::Verb kRecordVerb{"record", "Record from a device",
                            "tactograph record -o oak\n"
                            "  tactograph record -d sim:surface=C,speed=50mm/s,seed=1 --time 2s -o grating\n"
                            "  tactograph record -d sim:surface=triangle,period=1mm,depth=0.1mm,load=0.6N "
                            "--time 1s -o figure1 --subject S01\n"
                            "  tactograph record -d sim:paced=1,strokes=10 --strokes 5 --template "
                            "'{subject}_{surface}_{take}' --subject S01 --surface oak",
                            declare_record};

}  // namespace tacto::capture
