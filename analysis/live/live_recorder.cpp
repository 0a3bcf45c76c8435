// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "capture/record/take_name.hpp"
#include "capture/table/text_encoding.hpp"
#include "data-schema/control/control.hpp"
#include "data-schema/report/report_text.hpp"
#include "firmware-host/open_device.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using std::chrono::steady_clock;

constexpr auto kViewEvery = std::chrono::milliseconds(100);
constexpr std::size_t kLongestLine = 200;  // bytes of a name or label
constexpr std::size_t kMostUnread = 100;   // to a page that does not read

Result<void> check_line(std::string_view words) {
  if (!words.empty() && words.size() <= kLongestLine && capture::is_utf8(words) &&
      std::ranges::none_of(words, [](unsigned char c) { return c < 0x20 || c == 0x7F; }))
    return {};
  return fail(ErrorKind::malformed, "is no name or label", "request",
              fmt::format("write one line of 1 to {} bytes", kLongestLine));
}

}  // namespace

class LiveRecorder::Page final : public WebConversation {
 public:
  explicit Page(LiveRecorder& recorder) : recorder_(recorder) {}
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  ~Page() override { std::erase(recorder_.pages_, this); }

  std::string receive_text(std::string_view text) override {
    const auto done = recorder_.obey(text);
    return done ? schema::control_reply_line("", {}) : schema::control_error_line("", done.error());
  }
  std::string receive_bytes(std::span<const std::uint8_t>) override {
    return schema::control_error_line("", {ErrorKind::malformed, "a request is a text", "request", ""});
  }

 private:
  LiveRecorder& recorder_;
};

LiveRecorder::~LiveRecorder() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

std::unique_ptr<WebConversation> LiveRecorder::converse() {
  auto page = std::make_unique<Page>(*this);
  pages_.push_back(page.get());
  page->to_say.push_back(state_event());
  return page;
}

Result<void> LiveRecorder::obey(std::string_view line) {
  const std::string_view verb = line.substr(0, line.find(' '));
  const std::string_view words = line.substr(std::min(verb.size() + 1, line.size()));
  if (verb == "record") {
    TACTO_TRY(check_line(words));
    if (words.front() == '.')
      return fail(ErrorKind::malformed, "a name does not begin with a dot", "request", "leave it out");
    return begin(words);
  }
  if (over_ && (verb == "mark" || line == "stop"))
    return fail(ErrorKind::unsuitable, "there is no recording", "request", "begin one");
  if (verb == "mark") {
    TACTO_TRY(check_line(words));
    const std::lock_guard lock(mutex_);
    labels_.emplace_back(words);
    return {};
  }
  if (line == "stop") return stop_ = true, Result<void>();
  return fail(ErrorKind::malformed, "is no request", "request",
              "write 'record NAME', 'mark LABEL' or 'stop'");
}

Result<void> LiveRecorder::begin(std::string_view name) {
  if (!over_) return fail(ErrorKind::unsuitable, "a recording is in progress", name_, "end it first");
  auto stem = capture::name_of_take(folder_ + "/{name}-{take}", {{"name", std::string(name)}});
  TACTO_TRY(stem);
  if (thread_.joinable()) thread_.join();
  capture::RecordRequest request;
  request.name = name_ = std::move(*stem);
  labels_.clear();
  view_.reset();
  seen_ = steady_clock::now();
  stop_ = over_ = false;
  thread_ = std::thread([this, request = std::move(request)] { run(request); });
  return {};
}

void LiveRecorder::tell(const cli::Report& event) {
  const std::lock_guard lock(mutex_);
  events_.push_back(cli::json_line(event));
}

void LiveRecorder::run(capture::RecordRequest request) {
  const auto recorded = make(std::move(request));
  cli::Report event;
  if (!recorded) {
    const schema::Error& error = recorded.error();
    event.add("event", "failed")
        .add("what", error.what)
        .add("where", error.where)
        .add("remedy", error.remedy);
  } else {
    const schema::RecordingHeader& header = recorded->recording.header;
    event.add("event", "recorded").add("name", recorded->recording.stem);
    event.add("duration_s", schema::duration_s(header)).add("strokes", header.strokes.size());
    event.add("lost_frames", recorded->counts.lost_frames).add("gaps", header.gaps.size());
    event.add("marks", header.marks.size()).add("ended", header.ended).add("warnings", header.warnings);
  }
  over_ = true;
  tell(event);
}

Result<capture::Recorded> LiveRecorder::make(capture::RecordRequest request) {
  const auto opened = firmware_host::open_device_to_record(device_);
  TACTO_TRY(opened);
  firmware_host::Device& device = *opened->device;
  if (!device.is_real_time() && !opened->ends_by_itself)
    return fail(ErrorKind::usage, "this device runs faster than real time and would fill the disk", device_,
                "with paced=1 it runs in real time");
  auto calibration = capture::calibration_of(device.capabilities().serial, {});
  TACTO_TRY(calibration);
  request.calibration = std::move(*calibration);
  capture::RecordHooks hooks;
  hooks.stop = [this] { return stop_.load(); };
  hooks.new_marks = [this] {
    const std::lock_guard lock(mutex_);
    return std::exchange(labels_, {});
  };
  hooks.marked = [this](const schema::Mark& mark, double time_s) {
    tell(cli::Report().add("event", "mark").add("label", mark.label).add("time_s", time_s));
  };
  hooks.view = [this](const capture::LiveView& view, const schema::RecordingHeader& header) {
    const std::lock_guard lock(mutex_);
    if (!view_) channels_ = header.channels;
    view_ = view;
    seen_ = steady_clock::now();
  };
  return capture::record(device, request, hooks);
}

std::string LiveRecorder::state_event() {
  const std::lock_guard lock(mutex_);
  cli::Report event;
  event.add("event", "recording").add("device", device_);
  if (over_) return cli::json_line(event.add("state", "idle"));
  event.add("state", view_ ? "recording" : "opening").add("name", name_);
  event.add("late_s", std::chrono::duration<double>(steady_clock::now() - seen_).count());
  if (!view_) return cli::json_line(event);
  event.add("time_s", view_->time_s).add("strokes", view_->strokes).add("lost_frames", view_->lost_frames);
  if (view_->speed_mps) event.add("speed_mps", *view_->speed_mps);
  if (view_->normal_n) event.add("normal_n", *view_->normal_n);
  event.add("disk_left_bytes", view_->disk_left_bytes);
  std::vector<cli::Report> rows;
  for (std::size_t i = 0; i < channels_.size(); ++i)
    rows.push_back(cli::Report()
                       .add("name", channels_[i].name)
                       .add("quantity", channels_[i].quantity)
                       .add("unit", channels_[i].unit)
                       .add("smallest", view_->levels[i].smallest)
                       .add("largest", view_->levels[i].largest)
                       .add("clipped", view_->levels[i].clipped)
                       .add("unchanged_s", view_->levels[i].unchanged_s));
  return cli::json_line(event.add("channels", std::move(rows)));
}

void LiveRecorder::step() {
  if (pages_.empty()) return;
  std::vector<std::string> events;
  {
    const std::lock_guard lock(mutex_);
    events.swap(events_);
  }
  const auto now = steady_clock::now();
  if (!events.empty() || (!over_ && now >= next_)) {
    next_ = now + kViewEvery;
    events.push_back(state_event());
  }
  for (Page* const page : pages_)
    if (page->to_say.size() < kMostUnread)
      for (const std::string& event : events) page->to_say.push_back(event);
}

}  // namespace tacto::analysis
