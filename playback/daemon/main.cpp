// SPDX-License-Identifier: GPL-3.0-or-later
// tactographd: plays textures on a device, controlled over a socket. See playback/README.md and CONTROL.md.
#include <fmt/format.h>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "data-schema/base/format_version.hpp"
#include "data-schema/base/standard_descriptors.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/report/terminal.hpp"
#include "data-schema/version.hpp"
#include "playback/control/control_server.hpp"
#include "playback/control/control_token.hpp"
#include "playback/daemon/service.hpp"
#include "playback/host-loop/locked_memory.hpp"

namespace {

using namespace tacto;
using playback::ControlServer;
using playback::Service;

constexpr int kIdleMs = 100, kLoadingMs = 5;
constexpr double kStepS = 2e-3;
constexpr const char* kHelp =
    "tactographd: plays textures on a device, controlled by `tactograph ctl` or any client of its socket\n\n"
    "usage: tactographd --config FILE\n\n"
    "FILE is JSON: device, transducer, socket, sessions ... (defined by "
    "data-schema/schemas/daemon.schema.json).\nFor the emulated device:\n"
    R"(  {"kind": "daemon", "version": "1.0", "device": "sim:", "transducer": "wiertlewski2011", )"
    R"("socket": "control", "sessions": "sessions"})"
    "\nSIGTERM, SIGHUP (the terminal was closed) and Ctrl-C ramp the "
    "drive to zero and end the daemon.\nMessages go to stderr; systemd stores them in its journal.\n";

// Notifies systemd: a datagram to $NOTIFY_SOCKET (sd_notify(3)); does nothing if it is not set.
class ServiceManager {
 public:
  /// Reads NOTIFY_SOCKET and WATCHDOG_USEC.
  ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;
  ~ServiceManager();

  /// `assignment`: "READY=1", "STOPPING=1", "STATUS=playing oak".
  void tell(std::string_view assignment) const;
  /// Notifies the watchdog at half its time. Call often.
  void feed_watchdog(double now_s);

 private:
  std::string address_;
  int descriptor_ = -1;
  double watchdog_s_ = 0, next_s_ = 0;
};

std::string environment(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? "" : text;
}

ServiceManager::ServiceManager() : address_(environment("NOTIFY_SOCKET")) {
  if (address_.empty()) return;
  descriptor_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  watchdog_s_ = 1e-6 * std::atof(environment("WATCHDOG_USEC").c_str());
}

ServiceManager::~ServiceManager() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ServiceManager::tell(std::string_view assignment) const {
  sockaddr_un address{};
  if (descriptor_ < 0 || address_.size() >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, address_.data(), address_.size());
  if (address_.front() == '@') address.sun_path[0] = '\0';  // Linux's abstract sockets
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  [[maybe_unused]] const auto sent =
      sendto(descriptor_, assignment.data(), assignment.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
             reinterpret_cast<const sockaddr*>(&address), size);
}

void ServiceManager::feed_watchdog(double now_s) {
  if (watchdog_s_ <= 0 || now_s < next_s_) return;
  next_s_ = now_s + watchdog_s_ / 2;
  tell("WATCHDOG=1");
}

volatile std::sig_atomic_t stop_asked = 0;

void ask_to_stop(int) {
  stop_asked = 1;
}

// After `nohup` the signal is ignored, so that the daemon continues when the terminal is closed.
void stop_at_hangup(const struct sigaction& action) {
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

int failed(const schema::Error& error) {
  cli::write_message(fmt::format("tactographd: {}\n", schema::message(error)));
  return schema::exit_code(error.kind);
}

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// If no ticks are lost, a command or an event is.
std::string lost_words(double ticks) {
  return ticks > 0 ? fmt::format("{:.0f} ticks are", ticks) : "a command or event is";
}

// Changes of state go to the journal, all events to the watchers.
void tell(ControlServer& server, const ServiceManager& manager, std::string_view event,
          const schema::ControlFields& fields) {
  server.publish(event, fields);
  if (event == "recorder")
    cli::write_message(fmt::format("tactographd: {} not in the session: {}\n",
                                   lost_words(schema::control_number(fields, "lost_ticks")),
                                   schema::control_text(fields, "why")));
  if (event != "state") return;
  const std::string state = schema::control_text(fields, "state"), why = schema::control_text(fields, "why");
  cli::write_message(fmt::format("tactographd: {}{}{}\n", state, why.empty() ? "" : ": ", why));
  manager.tell("STATUS=" + state);
}

void serve_until_asked(ControlServer& server, Service& service, ServiceManager& manager) {
  const auto handle = [&](const schema::ControlRequest& request) { return service.handle(request); };
  for (double served_s = steady_s(); stop_asked == 0;) {
    service.stream_ticks(server.ticks_watched());
    const bool busy = service.step(kStepS);
    if (const auto answer = service.finished_load()) server.answer_late(*answer);
    server.serve(busy ? 0 : service.loading() ? kLoadingMs : kIdleMs, handle);
    if (server.stop_waits()) service.give_up_load();
    const double passed_s = steady_s() - std::exchange(served_s, steady_s());
    service.stay(server.lines_received(service.stay_rules().client), passed_s);
    manager.feed_watchdog(steady_s());
  }
}

// A load in progress cannot be interrupted, and its result is no longer needed.
void end_without_loading(std::unique_ptr<ControlServer>& server) {
  server.reset();  // removes the socket
  std::fflush(nullptr);
  std::_Exit(0);
}

schema::Result<std::unique_ptr<ControlServer>> listening(const schema::DaemonConfig& config) {
  playback::SocketPlace place{config.socket, config.socket_group, config.most_clients, std::nullopt};
  if (config.tcp_port) {
    auto token = playback::read_control_token(config.tcp_token_file);
    TACTO_TRY(token);
    place.loopback = {*config.tcp_port, std::move(*token)};
  }
  return ControlServer::listen(place);
}

std::string places_of(const ControlServer& server, const schema::DaemonConfig& config) {
  if (!config.tcp_port) return config.socket;
  return fmt::format("{} and 127.0.0.1:{}", config.socket, server.tcp_port());
}

int run(const char* config_path) {
  const auto config = schema::read_daemon_config(config_path);
  if (!config) return failed(config.error());
  auto server = listening(*config);
  if (!server) return failed(server.error());
  ServiceManager manager;
  const auto publish = [&](std::string_view event, const schema::ControlFields& fields) {
    tell(**server, manager, event, fields);
  };
  const auto service = Service::open(*config, publish);
  if (!service) return failed(service.error());
  for (const auto& [file, version] : schema::newer_versions())
    cli::write_message(fmt::format("tactographd: {}\n", schema::unknown_note(file, version, {})));
  if (!playback::lock_memory()) cli::write_message("tactographd: memory is not locked (LimitMEMLOCK)\n");
  cli::write_message(fmt::format("tactographd: ready on {}\n", places_of(**server, *config)));
  manager.tell("READY=1");
  serve_until_asked(**server, **service, manager);
  manager.tell("STOPPING=1");
  (*service)->end();
  if ((*service)->loading()) end_without_loading(*server);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  schema::open_closed_descriptors();
  const std::string_view first = argc > 1 ? argv[1] : "";
  if (first == "--help" || first == "-h") return std::fputs(kHelp, stdout) < 0 ? 1 : 0;
  if (first == "--version") return std::puts(kCreator.data()) < 0 ? 1 : 0;
  if (argc != 3 || first != "--config")
    return failed(
        {schema::ErrorKind::usage, "--config FILE is required", "command line", "see tactographd --help"});
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  stop_at_hangup(action);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  return run(argv[2]);
}
