// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "analysis/live/live_access.hpp"
#include "analysis/live/live_daemon.hpp"
#include "analysis/live/live_folder.hpp"
#include "analysis/live/live_jobs.hpp"
#include "analysis/live/live_recorder.hpp"
#include "analysis/live/live_scene.hpp"
#include "analysis/live/live_session.hpp"
#include "data-schema/base/module.hpp"
#include "data-schema/control/control.hpp"
#include "data-schema/control/live_request.hpp"
#include "data-schema/files/embedded_files.hpp"

namespace tacto::analysis {

/// The files of the page; empty if the program was built without it: without libwebsockets, clang-16 or
/// lld-16.
std::span<const schema::EmbeddedFile> live_assets();

namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr int kFirstPort = 7230, kPortsTried = 20;
constexpr std::string_view kDaemonPath = "/daemon", kJobsPath = "/jobs", kShapePath = "/shape/",
                           kChangePath = "/change/", kExportPath = "/export/", kScenePath = "/scene-session",
                           kRecorderPath = "/recorder", kSectionPath = "/section/";
constexpr std::size_t kLongestPath = 256;

std::string_view type_of_asset(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> kTypes[] = {
      {".html", "text/html; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".wasm", "application/wasm"}};
  for (const auto& [ending, type] : kTypes)
    if (name.ends_with(ending)) return type;
  return "application/octet-stream";
}

WebAnswer json_answer(std::string body, int status = 200) {
  WebAnswer answer;
  answer.status = status;
  answer.type = "application/json";
  answer.body = std::move(body);
  return answer;
}

WebAnswer error_answer(const schema::Error& error) {
  return json_answer(schema::control_error_line("", error), error.kind == ErrorKind::not_found ? 404 : 422);
}

template <class Value>
WebAnswer bytes_answer(const std::vector<Value>& values) {
  WebAnswer answer;
  answer.type = "application/octet-stream";
  answer.body.assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
  return answer;
}

// One page: it plays one texture at a time, or with `scenes` one scene, and may keep what it played.
class Page final : public WebConversation {
 public:
  Page(LiveFolder& folder, LiveScenes* scenes, std::size_t& kept)
      : folder_(folder), scenes_(scenes), kept_(kept) {}

  std::string receive_text(std::string_view text) override {
    auto done = obey(text);
    return done ? schema::control_reply_line("", *done) : schema::control_error_line("", done.error());
  }
  std::string receive_bytes(std::span<const std::uint8_t> bytes) override {
    if (session_ == nullptr) return {};  // it could not begin; the page has shown why
    const auto taken = session_->take(bytes);
    const auto fault = session_->take_fault();
    if (taken && fault)
      return schema::control_event_line("fault", {{"what", fault->what}, {"remedy", fault->remedy}});
    if (taken) return {};
    session_.reset();
    return schema::control_error_line("", taken.error());
  }

 private:
  Result<schema::ControlFields> obey(std::string_view text) {
    const auto request = schema::parse_live_request(text);
    TACTO_TRY(request);
    if (request->verb == schema::LiveVerb::begin) return begin(request->made);
    if (request->verb == schema::LiveVerb::change) return change(*request);
    if (request->verb == schema::LiveVerb::keep) return keep();
    return fail(ErrorKind::usage, "this page is its own device", "request", "steer the daemon on its page");
  }
  Result<schema::ControlFields> begin(std::size_t made) {
    session_.reset();
    auto session = session_of(made);
    TACTO_TRY(session);
    session_ = std::move(*session);
    return schema::ControlFields{{"begun", static_cast<std::int64_t>(made)}};
  }
  Result<std::unique_ptr<LiveSession>> session_of(std::size_t made) {
    if (scenes_ != nullptr) {
      const auto scene = scenes_->made(made);
      TACTO_TRY(scene);
      return LiveSession::begin(**scene);
    }
    const auto texture = folder_.made(made);
    TACTO_TRY(texture);
    return LiveSession::begin(**texture);
  }
  Result<schema::ControlFields> change(const schema::LiveRequest& request) {
    if (scenes_ != nullptr)
      return fail(ErrorKind::usage, "a scene changes by its numbers", "request", "move its sliders");
    const auto change = folder_.change(request.playing, request.made, request.times);
    TACTO_TRY(change);
    if (session_ == nullptr) return nothing_played();
    TACTO_TRY(session_->change(*change));
    return schema::ControlFields{{"changed", static_cast<std::int64_t>(request.made)}};
  }
  static tl::unexpected<schema::Error> nothing_played() {
    return fail(ErrorKind::unsuitable, "there is nothing to keep", "the page", "play first");
  }
  Result<schema::ControlFields> keep() {
    if (session_ == nullptr) return nothing_played();
    const auto session = std::exchange(session_, nullptr);
    const auto kept = session->keep();
    TACTO_TRY(kept);
    ++kept_;
    return schema::ControlFields{{"kept", kept->path},
                                 {"ticks", static_cast<std::int64_t>(kept->ticks)},
                                 {"lost_ticks", static_cast<std::int64_t>(kept->lost_ticks)}};
  }

  LiveFolder& folder_;
  LiveScenes* scenes_;  // null: textures
  std::size_t& kept_;
  std::unique_ptr<LiveSession> session_;
};

class Site {
 public:
  Site(const LiveOptions& options, int port)
      : access_(port),
        folder_(options.folder, options.transducer),
        scenes_(options.folder),
        daemon_(options.socket, folder_),
        jobs_(folder_),
        recorder_(options.folder, options.device) {
    folder_.refresh();
  }
  WebSite handlers() {
    return {[this](const WebRequest& request) { return answer(request); },
            [this](const WebRequest& request) -> std::unique_ptr<WebConversation> {
              if (request.path == kDaemonPath) return daemon_.converse();
              if (request.path == kJobsPath) return jobs_.converse();
              if (request.path == kRecorderPath) return recorder_.converse();
              return std::make_unique<Page>(folder_, request.path == kScenePath ? &scenes_ : nullptr, kept_);
            }};
  }
  LiveDaemon& daemon() { return daemon_; }
  LiveJobs& jobs() { return jobs_; }
  LiveRecorder& recorder() { return recorder_; }
  const LiveAccess& access() const { return access_; }
  std::size_t kept() const { return kept_; }

 private:
  WebAnswer answer(const WebRequest& request) {
    auto refused = access_.refusal(request);
    WebAnswer answer = refused ? std::move(*refused) : content(request);
    if (!refused) access_.let_in(request, answer);
    add_safe_headers(answer);
    return answer;
  }
  WebAnswer content(const WebRequest& request) {
    if (request.path.size() > kLongestPath) return too_long();
    if (request.upgrade)
      return request.path == "/session" || request.path == kScenePath || request.path == kDaemonPath ||
                     request.path == kJobsPath || request.path == kRecorderPath
                 ? WebAnswer()
                 : not_found();
    if (auto answer = scene_content(request.path, request.query)) return std::move(*answer);
    if (request.path == "/loaded") return loaded();
    if (request.path == "/textures") {
      folder_.refresh();
      return json_answer(folder_.list_json());
    }
    if (const auto index = number_after("/texture/", request.path)) return texture(*index, request.query);
    if (const auto index = number_after("/thumbnail/", request.path)) {
      const auto picture = folder_.thumbnail(*index);
      return picture ? bytes_answer(*picture) : error_answer(picture.error());
    }
    if (const auto index = number_after("/spectrogram/", request.path)) return spectrogram(*index);
    if (const auto job = number_after("/result/", request.path)) return result(*job);
    if (request.path.starts_with(kShapePath)) return shape(request);
    if (request.path.starts_with(kExportPath))
      return exported(std::string_view(request.path).substr(kExportPath.size()), request.query);
    for (const std::string_view part : {"cells", "known"})
      if (const auto number = number_after(fmt::format("/{}/", part), request.path))
        return cells_of(part, *number);
    if (request.path.starts_with(kChangePath))
      return change(std::string_view(request.path).substr(kChangePath.size()));
    for (const std::string_view part : {"upload", "map", "tray"})
      if (const auto number = number_after(fmt::format("/{}/", part), request.path))
        return bytes_of(part, *number);
    const std::string_view name =
        request.path == "/" ? "index.html" : std::string_view(request.path).substr(1);
    for (const schema::EmbeddedFile& asset : live_assets())
      if (asset.name == name) return asset_answer(asset);
    return not_found();
  }
  std::optional<WebAnswer> scene_content(std::string_view path, std::string_view query) {
    if (path == "/scenes") return json_answer(scenes_.list_json());
    if (const auto index = number_after("/scene/", path)) {
      const auto device = number_after("device=", query);
      if (!query.empty() && !device) return not_found();
      const auto number = scenes_.make(*index, device);
      return number ? json_answer(scene_json(*number, **scenes_.made(*number)))
                    : error_answer(number.error());
    }
    if (const auto index = number_after("/scene-thumbnail/", path)) {
      const auto picture = scenes_.thumbnail(*index);
      return picture ? bytes_answer(*picture) : error_answer(picture.error());
    }
    if (const auto number = number_after("/scene-upload/", path)) {
      const auto scene = scenes_.made(*number);
      return scene ? bytes_answer(joined((*scene)->upload)) : error_answer(scene.error());
    }
    if (path.starts_with(kSectionPath)) return section(path.substr(kSectionPath.size()));
    return std::nullopt;
  }
  // "NUMBER/SECTION/PLACE_M"
  WebAnswer section(std::string_view numbers) {
    std::size_t number = 0, which = 0;
    double through_m = 0;
    if (!read_number(numbers, number) || !read_number(numbers, which) || !read_number(numbers, through_m) ||
        !numbers.empty() || !std::isfinite(through_m))
      return not_found();
    const auto scene = scenes_.made(number);
    if (!scene) return error_answer(scene.error());
    if (which >= ((*scene)->plane ? 1 : std::size(kPieceSections))) return not_found();
    return bytes_answer(scene_pixels(**scene, which, through_m).rgb);
  }
  WebAnswer spectrogram(std::size_t index) {
    const auto number = folder_.make_spectrogram(index);
    return number ? json_answer(spectrogram_json(*number, **folder_.spectrogram(*number)))
                  : error_answer(number.error());
  }
  WebAnswer shape(const WebRequest& request) {
    const auto made = folder_.shape(std::string_view(request.path).substr(kShapePath.size()), request.query);
    return made ? json_answer(*made) : error_answer(made.error());
  }
  // A page that a verb has written: without scripts, and of an origin of its own.
  WebAnswer result(std::size_t job) {
    auto page = jobs_.page(job);
    if (!page) return error_answer(page.error());
    WebAnswer answer;
    answer.type = "text/html; charset=utf-8";
    answer.body = std::move(*page);
    answer.headers.emplace_back("content-security-policy:",
                                "sandbox; default-src 'none'; style-src 'unsafe-inline'; img-src data:; "
                                "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    return answer;
  }
  WebAnswer cells_of(std::string_view part, std::size_t number) {
    const auto live = folder_.spectrogram(number);
    if (!live) return error_answer(live.error());
    const schema::Spectrogram& spectrogram = (*live)->spectrogram;
    return bytes_answer(part == "cells" ? stored_cells(spectrogram) : known_limits(spectrogram));
  }
  // "NUMBER/FORM"
  WebAnswer exported(std::string_view what, const std::string& query) {
    std::size_t number = 0;
    if (!read_number(what, number)) return not_found();
    const auto live = folder_.spectrogram(number);
    if (!live) return error_answer(live.error());
    const auto part = parse_spectrogram_part(query);
    if (!part) return error_answer(part.error());
    auto file = spectrogram_file(**live, *part, std::string(what));
    if (!file) return error_answer(file.error());
    WebAnswer answer;
    answer.type = "application/octet-stream";
    answer.body = std::move(*file);
    answer.headers.emplace_back("content-disposition:", "attachment");
    return answer;
  }
  // "NEXT/PLAYING/TIMES"
  WebAnswer change(std::string_view numbers) {
    std::size_t next = 0, playing = 0;
    double times = 0;
    if (!read_number(numbers, next) || !read_number(numbers, playing) || !read_number(numbers, times) ||
        !numbers.empty() || !(std::abs(times) <= schema::kMostTimes))
      return not_found();
    const auto change = folder_.change(playing, next, times);
    return change ? bytes_answer(joined(change->frames)) : error_answer(change.error());
  }
  // Takes a number, and a slash behind it, from the beginning of a text.
  template <class Number>
  static bool read_number(std::string_view& text, Number& number) {
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failed != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) return true;
    if (text.front() != '/' || text.size() == 1) return false;
    text.remove_prefix(1);
    return true;
  }
  static WebAnswer too_long() {
    WebAnswer answer;
    answer.status = 414;
    answer.body = fmt::format("no page has a path of over {} bytes\n", kLongestPath);
    return answer;
  }
  static WebAnswer not_found() {
    WebAnswer answer;
    answer.status = 404;
    answer.body = "there is no such page\n";
    return answer;
  }
  static WebAnswer asset_answer(const schema::EmbeddedFile& asset) {
    WebAnswer answer;
    answer.type = type_of_asset(asset.name);
    answer.body = asset.content;
    return answer;
  }
  static std::optional<std::size_t> number_after(std::string_view beginning, std::string_view path) {
    if (!path.starts_with(beginning)) return std::nullopt;
    std::string_view digits = path.substr(beginning.size());
    std::size_t number = 0;
    return read_number(digits, number) && digits.empty() ? std::optional(number) : std::nullopt;
  }
  WebAnswer texture(std::size_t index, const std::string& query) {
    constexpr std::string_view kInverse = "inverse=";
    const bool named = query.starts_with(kInverse);
    const auto number =
        folder_.make(index, named ? std::optional(query.substr(kInverse.size())) : std::nullopt);
    return number ? json_answer(figures_json(*number, **folder_.made(*number)))
                  : error_answer(number.error());
  }
  WebAnswer loaded() {
    folder_.refresh();
    const auto map = folder_.map_of(daemon_.loaded());
    return map ? bytes_answer(*map) : error_answer(map.error());
  }
  WebAnswer bytes_of(std::string_view part, std::size_t number) {
    const auto made = folder_.made(number);
    if (!made) return error_answer(made.error());
    const LiveTexture& live = **made;
    if (part == "map") return bytes_answer(live.map);
    if (part == "tray") return bytes_answer(live.tray);
    return bytes_answer(joined(live.upload));
  }
  static std::vector<std::uint8_t> joined(const std::vector<Frame>& frames) {
    std::vector<std::uint8_t> bytes;
    for (const Frame& frame : frames) bytes.insert(bytes.end(), frame.begin(), frame.end());
    return bytes;
  }

  LiveAccess access_;
  LiveFolder folder_;
  LiveScenes scenes_;
  LiveDaemon daemon_;
  LiveJobs jobs_;
  LiveRecorder recorder_;
  std::size_t kept_ = 0;
};

Result<void> check_live(const LiveOptions& options) {
  if (live_assets().empty())
    return fail(ErrorKind::unsuitable, "this program was built without the live page", "tactograph live",
                "install libwebsockets-dev, clang-16 and lld-16, and build again");
  if (std::error_code ignored; !std::filesystem::is_directory(options.folder, ignored))
    return fail(ErrorKind::not_found, "there is no such folder", options.folder,
                "name a folder with textures");
  const auto transducer = schema::read_transducer(options.transducer);
  TACTO_TRY(transducer);
  return {};
}

// A site for the first port that is free, and its server.
struct Served {
  std::unique_ptr<Site> site;
  std::unique_ptr<WebSite> handlers;
  std::unique_ptr<WebServer> server;
};

Result<Served> serve_on_free_port(const LiveOptions& options, WebEntry entry) {
  const int first = options.port.value_or(kFirstPort), last = options.port ? first : first + kPortsTried - 1;
  for (int port = first; port <= last; ++port) {
    Served served;
    served.site = std::make_unique<Site>(options, port);
    served.handlers = std::make_unique<WebSite>(served.site->handlers());
    served.server.reset(entry(port, *served.handlers));
    if (served.server != nullptr) return served;
  }
  return fail(ErrorKind::unsuitable,
              first == last ? fmt::format("port {} of 127.0.0.1 is taken or not permitted", first)
                            : fmt::format("ports {} to {} of 127.0.0.1 are taken", first, last),
              "tactograph live", "choose another one with --port");
}

}  // namespace

Result<LiveSummary> run_live(const LiveOptions& options,
                             const std::function<void(const std::string& address)>& announce,
                             const std::function<bool()>& stop) {
  TACTO_TRY(check_live(options));
  const auto entry = schema::function_in_module(kWebModule, kWebEntry);
  TACTO_TRY(entry);
  const auto served = serve_on_free_port(options, reinterpret_cast<WebEntry>(*entry));
  TACTO_TRY(served);
  const std::string address = served->site->access().address();
  announce(address);
  LiveDaemon& daemon = served->site->daemon();
  daemon.watch_with([&server = *served->server](int descriptor, std::function<bool()> readable) {
    server.watch(descriptor, std::move(readable));
  });
  served->server->serve([&] {
    daemon.step();
    served->site->jobs().step();
    served->site->recorder().step();
    return stop();
  });
  return LiveSummary{address, served->site->kept()};
}

}  // namespace tacto::analysis
