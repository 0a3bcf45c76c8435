// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_daemon.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>

#include "playback/control/control_socket.hpp"

namespace tacto::analysis {

using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;
using schema::ErrorKind;
using schema::fail;
using schema::LiveVerb;
using schema::Result;

namespace {

constexpr std::chrono::milliseconds kTryEvery{500};
constexpr double kDeadManS = 2;
constexpr int kMostReads = 100;          // of 4 KB: more than a socket's buffer
constexpr std::size_t kMostToSay = 500;  // texts for a page that does not read, 1 MB; then events are lost
constexpr const char* kHelloId = "\"hello\"";

std::string hello_line() {
  ControlRequest hello;
  hello.verb = ControlVerb::hello;
  hello.version = schema::kControlVersion;
  hello.id_json = kHelloId;
  return schema::control_request_line(hello);
}

std::string watch_line() {
  ControlRequest watch;
  watch.verb = ControlVerb::watch;
  watch.ticks = true;
  return schema::control_request_line(watch);
}

ControlVerb verb_of(LiveVerb verb) {
  switch (verb) {
    case LiveVerb::load:
      return ControlVerb::load;
    case LiveVerb::arm:
      return ControlVerb::arm;
    case LiveVerb::play:
      return ControlVerb::play;
    case LiveVerb::stop:
      return ControlVerb::stop;
    case LiveVerb::disarm:
      return ControlVerb::disarm;
    case LiveVerb::gain:
      return ControlVerb::gain;
    default:
      return ControlVerb::status;
  }
}

std::string gone_event(const schema::Error& why) {
  return schema::control_event_line(
      "daemon", {{"here", false}, {"what", why.what}, {"where", why.where}, {"remedy", why.remedy}});
}

}  // namespace

class LiveDaemon::Page final : public WebConversation {
 public:
  explicit Page(LiveDaemon& daemon) : daemon_(daemon) {}
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  ~Page() override { daemon_.leave(*this); }

  std::string receive_text(std::string_view text) override {
    const auto request = schema::parse_live_request(text);
    const auto done = request ? daemon_.ask(*this, *request) : schema::forward_error(request);
    if (done) return {};
    const auto id = request && request->id ? std::to_string(*request->id) : std::string();
    return schema::control_error_line(id, done.error());
  }
  std::string receive_bytes(std::span<const std::uint8_t>) override {
    return schema::control_error_line("", {ErrorKind::malformed, "a request is a text", "request", ""});
  }
  void tell(const std::string& text) { to_say.push_back(text); }
  bool reads() const { return to_say.size() < kMostToSay; }

 private:
  LiveDaemon& daemon_;
};

std::unique_ptr<WebConversation> LiveDaemon::converse() {
  auto page = std::make_unique<Page>(*this);
  pages_.push_back(page.get());
  for (const std::string& event : {about_, status_, state_})
    if (!event.empty()) page->tell(event);
  give_steering(steers_ == nullptr ? page.get() : steers_);
  return page;
}

// The drive falls: by this `stop`, and, if a page has armed, because its connection ends.
void LiveDaemon::leave(Page& page) {
  std::erase(pages_, &page);
  std::ranges::replace(asked_, &page, nullptr);
  if (steers_ != &page) return;
  if (steering_ && played_) {
    ControlRequest stop;
    stop.verb = ControlVerb::stop;
    steering_->send(schema::control_request_line(stop));
  }
  disconnect(steering_);
  asked_.clear();
  played_ = false;
  give_steering(nullptr);
}

void LiveDaemon::tell_all(const std::string& text) {
  for (Page* const page : pages_) page->tell(text);
}

void LiveDaemon::give_steering(Page* page) {
  steers_ = page;
  for (Page* const one : pages_)
    one->tell(schema::control_event_line("steering",
                                         {{"here", one == page}, {"taken", page != nullptr && one != page}}));
}

Result<LiveDaemon::Link> LiveDaemon::connect(void (LiveDaemon::*take)(std::string_view line),
                                             void (LiveDaemon::*lost)()) {
  const auto descriptor = playback::connect_control_socket(socket_);
  TACTO_TRY(descriptor);
  Link made = std::make_shared<playback::ControlClient>(*descriptor);
  made->send(hello_line());
  watch_with_(*descriptor, [this, weak = std::weak_ptr(made), take, lost] {
    const Link link = weak.lock();
    if (!link) return false;
    const auto is_used = [&] { return link == watching_ || link == steering_; };
    // To the end: of a connection that has ended, the server watches no longer.
    pollfd more{link->descriptor(), POLLIN, 0};
    for (int i = 0; i < kMostReads && is_used() && !link->silent() && poll(&more, 1, 0) > 0; ++i) {
      link->receive();
      for (auto line = link->take_line(); line && is_used(); line = link->take_line()) (this->*take)(*line);
    }
    if (is_used() && (link->silent() || link->is_endless())) (this->*lost)();
    return is_used();
  });
  return made;
}

// The server of the pages has a duplicate of the descriptor, so closing it is not enough.
void LiveDaemon::disconnect(Link& link) {
  if (link) ::shutdown(link->descriptor(), SHUT_RDWR);
  link.reset();
}

// If another client has armed, the daemon does not watch the page: this does.
void LiveDaemon::stop_if_silent() {
  constexpr std::chrono::duration<double> kSilent(kDeadManS);
  if (!steering_ || !played_ || std::chrono::steady_clock::now() - heard_ < kSilent) return;
  ControlRequest stop;
  stop.verb = ControlVerb::stop;
  steering_->send(schema::control_request_line(stop));
  asked_.push_back(nullptr);
  played_ = false;
}

void LiveDaemon::step() {
  stop_if_silent();
  if (pages_.empty()) {
    disconnect(watching_);
    about_.clear();
    status_.clear();
    state_.clear();
    return;
  }
  if (watching_) return;
  if (const auto now = std::chrono::steady_clock::now(); now >= next_try_) {
    next_try_ = now + kTryEvery;
    begin_watching();
  }
}

void LiveDaemon::begin_watching() {
  auto link = connect(&LiveDaemon::take_watched, &LiveDaemon::watching_lost);
  if (!link) return gone(link.error());
  watching_ = std::move(*link);
  watching_->send(watch_line());
}

// Answers come to hello, which has an id, and to watch.
void LiveDaemon::take_watched(std::string_view line) {
  auto reply = schema::parse_control_reply(line);
  if (!reply) return gone(reply.error());
  if (reply->event.empty() && !reply->ok) return gone(reply->error);
  const bool is_hello = schema::control_text(reply->fields, "id") == "hello";
  for (Page* const page : pages_)
    if (!reply->event.empty() && (page->reads() || reply->event == "state")) page->tell(std::string(line));
  if (reply->event.empty() || reply->event == "status")
    std::erase_if(reply->fields, [](const auto& field) {
      return field.first == "ok" || field.first == "id" || field.first == "event";
    });
  if (is_hello) {
    reply->fields.emplace_back("here", true);
    tell_all(about_ = schema::control_event_line("daemon", reply->fields));
  } else if (reply->event.empty()) {
    keep_status(reply->fields);
    tell_all(status_);
  } else if (reply->event == "status") {
    keep_status(reply->fields);
  } else if (reply->event == "state") {
    state_ = line;
  }
}

void LiveDaemon::keep_status(const ControlFields& fields) {
  loaded_ = schema::control_text(fields, "loaded");
  status_ = schema::control_event_line("status", fields);
  state_.clear();
}

void LiveDaemon::watching_lost() {
  gone({ErrorKind::device, "the daemon has ended or closed the connection", socket_,
        "see its journal; start it again"});
}

void LiveDaemon::gone(const schema::Error& why) {
  disconnect(watching_);
  disconnect(steering_);
  asked_.clear();
  played_ = false;
  status_.clear();
  state_.clear();
  loaded_.clear();
  if (const std::string event = gone_event(why); event != about_) tell_all(about_ = event);
}

// `stop` and `disarm` are for every page.
Result<void> LiveDaemon::ask(Page& page, const schema::LiveRequest& request) {
  if (request.verb < LiveVerb::steer || request.verb > LiveVerb::gain)
    return fail(ErrorKind::usage, "this page steers the daemon and does nothing else", "request",
                "use the page of textures or that of jobs");
  const bool stops = request.verb == LiveVerb::stop || request.verb == LiveVerb::disarm;
  if (request.verb == LiveVerb::steer || (steers_ == nullptr && !stops)) give_steering(&page);
  if (request.verb == LiveVerb::steer) return {};
  if (steers_ != &page && !stops)
    return fail(ErrorKind::usage, "another page steers the daemon", "this page", "press Steer here");
  if (steers_ == &page) heard_ = std::chrono::steady_clock::now();
  const auto line = line_of(request);
  TACTO_TRY(line);
  if (!steering_) {
    auto link = connect(&LiveDaemon::take_steered, &LiveDaemon::steering_lost);
    TACTO_TRY(link);
    steering_ = std::move(*link);
    asked_ = {nullptr};  // hello
  }
  if (!steering_->send(*line)) return steering_lost(), Result<void>();
  asked_.push_back(&page);
  if (request.verb == LiveVerb::play) played_ = true;
  if (stops) played_ = false;
  return {};
}

Result<std::string> LiveDaemon::line_of(const schema::LiveRequest& request) const {
  ControlRequest asked;
  asked.verb = verb_of(request.verb);
  if (request.id) asked.id_json = std::to_string(*request.id);
  asked.times_default = request.verb == LiveVerb::gain ? request.times_default : std::nullopt;
  if (request.verb == LiveVerb::load) {
    auto file = folder_.file(*request.texture);
    TACTO_TRY(file);
    asked.file = std::move(*file);
    asked.playback.inverse = request.inverse;
  }
  if (request.verb == LiveVerb::arm) {
    asked.while_connected = true;
    asked.dead_man_s = kDeadManS;
  }
  return schema::control_request_line(asked);
}

void LiveDaemon::take_steered(std::string_view line) {
  if (asked_.empty()) return;
  Page* const page = asked_.front();
  asked_.pop_front();
  if (page != nullptr) page->tell(std::string(line));
}

void LiveDaemon::steering_lost() {
  disconnect(steering_);
  const schema::Error why{ErrorKind::device, "the daemon has closed the connection", socket_,
                          "see its journal; then try again"};
  for (Page* const page : std::exchange(asked_, {}))
    if (page != nullptr) page->tell(schema::control_error_line("", why));
}

}  // namespace tacto::analysis
