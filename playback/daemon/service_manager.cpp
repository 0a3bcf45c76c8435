// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace tacto::playback {
namespace {

std::string environment(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? "" : text;
}

}  // namespace

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
  [[maybe_unused]] const auto told =
      sendto(descriptor_, assignment.data(), assignment.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
             reinterpret_cast<const sockaddr*>(&address), size);
}

void ServiceManager::feed_watchdog(double now_s) {
  if (watchdog_s_ <= 0 || now_s < next_s_) return;
  next_s_ = now_s + watchdog_s_ / 2;
  tell("WATCHDOG=1");
}

}  // namespace tacto::playback
