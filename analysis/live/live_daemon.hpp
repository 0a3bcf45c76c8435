// SPDX-License-Identifier: GPL-3.0-or-later
// Connects the pages of `tactograph live` with the daemon: all see what it does, one steers it.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/live/live_folder.hpp"
#include "analysis/live/server/web_server.hpp"
#include "data-schema/control/control.hpp"
#include "data-schema/control/live_request.hpp"
#include "playback/control/control_client.hpp"

namespace tacto::analysis {

/// The pages get the daemon's events and its answers as they are (CONTROL.md), and two of this class:
/// `daemon`
/// (`here`, then the answer to hello, or `what`, `where`, `remedy`) and `steering` (`here`: this page steers;
/// `taken`: another one does). The drive falls when the page that armed or played has left or says nothing
/// for two seconds. For the thread of WebServer::serve().
class LiveDaemon {
 public:
  using Watch = std::function<void(int descriptor, std::function<bool()> readable)>;

  LiveDaemon(std::string socket, LiveFolder& folder) : socket_(std::move(socket)), folder_(folder) {}
  /// Call before step().
  void watch_with(Watch watch) { watch_with_ = std::move(watch); }
  /// It must not outlive this object.
  std::unique_ptr<WebConversation> converse();
  /// Call at least every 50 ms. While there are pages, and no daemon, it tries to connect twice a second.
  void step();
  /// The file that the daemon has loaded, as the daemon named it; empty if there is none.
  const std::string& loaded() const { return loaded_; }

 private:
  class Page;
  // A connection to the daemon, or null.
  using Link = std::shared_ptr<playback::ControlClient>;

  schema::Result<Link> connect(void (LiveDaemon::*take)(std::string_view line), void (LiveDaemon::*lost)());
  static void disconnect(Link& link);
  void begin_watching();
  void take_watched(std::string_view line);
  void keep_status(const schema::ControlFields& fields);
  void watching_lost();
  void gone(const schema::Error& why);
  schema::Result<void> ask(Page& page, const schema::LiveRequest& request);
  schema::Result<std::string> line_of(const schema::LiveRequest& request) const;
  void take_steered(std::string_view line);
  void steering_lost();
  void give_steering(Page* page);
  void leave(Page& page);
  void stop_if_silent();
  void tell_all(const std::string& text);

  std::string socket_;
  LiveFolder& folder_;
  Watch watch_with_;
  std::vector<Page*> pages_;
  Page* steers_ = nullptr;
  Link watching_, steering_;
  std::deque<Page*> asked_;  // whose answers come next; null: no page's
  bool played_ = false;      // the pages' last word: the drive has to fall when they leave
  std::chrono::steady_clock::time_point heard_;  // of the page that steers: its last request
  std::chrono::steady_clock::time_point next_try_;
  std::string about_, status_,
      state_;  // the newest events, for a new page; state_ if it is newer than status_
  std::string loaded_;
};

}  // namespace tacto::analysis
