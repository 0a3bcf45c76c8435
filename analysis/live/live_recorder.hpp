// SPDX-License-Identifier: GPL-3.0-or-later
// Records from a device as `tactograph record` does, for the page of the device.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "analysis/live/server/web_server.hpp"
#include "capture/record/record.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::analysis {

/// One recording at a time, in the folder, for all pages. A page sends lines: "record NAME" (the recording is
/// NAME and a number, so that none is replaced), and as `record --commands` "mark LABEL" and "stop"; each is
/// answered as in the control protocol. All pages get the event `recording` ten times a second while there is
/// one (`state` opening, recording or idle; time, strokes, losses; of each channel the last values, and for
/// how long its code has not changed; `late_s`: for how long no frame has come), `mark`, and at its end
/// `recorded` or `failed`. It goes on when the pages leave, and ends with this object. The public functions
/// are for the thread of WebServer::serve().
class LiveRecorder {
 public:
  LiveRecorder(std::string folder, std::string device)
      : folder_(std::move(folder)), device_(std::move(device)) {}
  LiveRecorder(const LiveRecorder&) = delete;
  LiveRecorder& operator=(const LiveRecorder&) = delete;
  ~LiveRecorder();
  /// It must not outlive this object.
  std::unique_ptr<WebConversation> converse();
  /// Call at least every 50 ms.
  void step();

 private:
  class Page;
  schema::Result<void> obey(std::string_view line);
  schema::Result<void> begin(std::string_view name);
  std::string state_event();
  // On the thread of the recording.
  void run(capture::RecordRequest request);
  schema::Result<capture::Recorded> make(capture::RecordRequest request);
  void tell(const cli::Report& event);

  std::string folder_, device_, name_;
  std::vector<Page*> pages_;
  std::chrono::steady_clock::time_point next_;
  std::thread thread_;
  std::atomic<bool> stop_ = false, over_ = true;
  std::mutex mutex_;  // of the rest
  std::vector<std::string> labels_, events_;
  std::optional<capture::LiveView> view_;
  std::vector<schema::Channel> channels_;
  std::chrono::steady_clock::time_point seen_;  // when frames came
};

}  // namespace tacto::analysis
