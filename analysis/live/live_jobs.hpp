// SPDX-License-Identifier: GPL-3.0-or-later
// Runs verbs of the command for the pages: each in a process of its own, one after the other.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "analysis/live/live_folder.hpp"
#include "analysis/live/server/web_server.hpp"
#include "data-schema/control/live_request.hpp"

namespace tacto::analysis {

/// A job reads files of the folder and writes one page into it, under a name that is free. The pages get the
/// event `jobs` with all jobs when one has changed: number, state (waiting, running, done, failed,
/// cancelled), command, what it printed as messages (`said`) and as answer (`printed`), and, once it is
/// there, the name of the page. Requests: `run`, `cancel`, `save`. For the thread of WebServer::serve().
class LiveJobs {
 public:
  explicit LiveJobs(LiveFolder& folder) : folder_(folder) {}
  LiveJobs(const LiveJobs&) = delete;
  LiveJobs& operator=(const LiveJobs&) = delete;
  /// Ends the job that runs, within kEndsWithinS.
  ~LiveJobs();
  /// It must not outlive this object.
  std::unique_ptr<WebConversation> converse();
  /// Call at least every 50 ms: reads what the job prints, and starts the next one.
  void step();
  /// The page that a job has written. Errors: not_found.
  schema::Result<std::string> page(std::size_t number) const;

 private:
  class Page;
  struct Job {
    std::size_t number = 0;
    std::vector<std::string> words;  // of the command line, behind "tactograph"
    std::string output;
    std::string state = "waiting";
    std::string said, printed;
    pid_t process = 0;
    int messages = -1, answer = -1;  // the pipes' ends
    bool cancelled = false;
  };
  schema::Result<std::size_t> add(const schema::LiveRequest& request);
  schema::Result<void> cancel(std::size_t number);
  void start(Job& job);
  void read_output(Job& job);
  bool take(int descriptor, std::string& text);
  void end(Job& job, int status);
  void tell_all();
  std::string event() const;

  LiveFolder& folder_;
  std::deque<Job> jobs_;
  std::size_t next_ = 0;
  bool changed_ = false;
  std::string told_;  // the newest event
  std::vector<Page*> pages_;
};

}  // namespace tacto::analysis
