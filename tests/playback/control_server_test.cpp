// SPDX-License-Identifier: GPL-3.0-or-later
// Who is answered when: the control socket under clients that send much, wait, leave, or must not ask.
#include "playback/daemon/control_server.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>

#include "playback/daemon/control_socket.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::playback {
namespace {

using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;

constexpr const char* kHello = "{\"request\":\"hello\",\"version\":\"1.0\"}\n";
constexpr const char* kStatus = "{\"request\":\"status\"}\n";
constexpr const char* kLoad = "{\"request\":\"load\",\"file\":\"oak\"}\n";
constexpr const char* kStop = "{\"request\":\"stop\"}\n";
constexpr const char* kWatch = "{\"request\":\"watch\"}\n";

std::string again(const char* line, int times) {
  std::string lines;
  for (int i = 0; i < times; ++i) lines += line;
  return lines;
}

class TestClient {
 public:
  explicit TestClient(const std::string& path) : descriptor_(connect_control_socket(path).value()) {}
  TestClient(const TestClient&) = delete;
  TestClient& operator=(const TestClient&) = delete;
  ~TestClient() { hang_up(); }

  void say(const std::string& text) const {
    ASSERT_EQ(::send(descriptor_, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  }
  void say_no_more() const { shutdown(descriptor_, SHUT_WR); }
  void hang_up() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }
  /// Lines that have come and are not read yet.
  std::vector<std::string> heard() {
    char bytes[65536];
    for (ssize_t got = 1; (got = recv(descriptor_, bytes, sizeof bytes, MSG_DONTWAIT)) > 0;)
      text_.append(bytes, static_cast<std::size_t>(got));
    std::vector<std::string> lines;
    for (std::size_t end = 0; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1))
      lines.push_back(text_.substr(0, end));
    return lines;
  }

 private:
  int descriptor_;
  std::string text_;
};

class ControlServing : public testing::Test {
 protected:
  // A `load` is answered late, all else at once.
  void serve(int timeout_ms = 0) {
    server_->serve(timeout_ms, [this](const ControlRequest& request) -> ControlServer::Answer {
      handled_.push_back(request.verb);
      if (request.verb == ControlVerb::load) return std::nullopt;
      return ControlFields{};
    });
  }
  std::unique_ptr<TestClient> greeted() {
    auto client = std::make_unique<TestClient>(path_);
    client->say(kHello);
    for (int i = 0; i < 3; ++i) serve();
    EXPECT_EQ(client->heard().size(), 1U);
    handled_.clear();
    return client;
  }

  tests::TemporaryFolder folder_;
  std::string path_ = folder_ / "control";
  std::unique_ptr<ControlServer> server_ = ControlServer::listen({path_, "", 8, std::nullopt}).value();
  std::vector<ControlVerb> handled_;
};

TEST_F(ControlServing, OneWhoSendsMuchHoldsUpNobody) {
  const auto busy = greeted(), other = greeted();
  busy->say(again(kStatus, 100));
  other->say(kStop);
  serve();
  EXPECT_LE(handled_.size(), 3U) << "two lines of the one, the other's only one";
  EXPECT_EQ(other->heard().size(), 1U);
}

TEST_F(ControlServing, LinesThatAreHereNeedNothingNewToBeAnswered) {
  const auto client = greeted();
  client->say(again(kStatus, 5));
  const auto before = std::chrono::steady_clock::now();
  for (int i = 0; i < 3; ++i) serve(10'000);
  EXPECT_EQ(client->heard().size(), 5U);
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(9));
}

TEST_F(ControlServing, WhoSaysNoMoreIsAnsweredAllTheSame) {
  const auto client = greeted();
  client->say(again(kStatus, 7));
  client->say_no_more();
  for (int i = 0; i < 6; ++i) serve();
  EXPECT_EQ(client->heard().size(), 7U);
  EXPECT_EQ(server_->clients(), 0U);
}

TEST_F(ControlServing, AStopIsSeenBehindALoadThatIsNotAnswered) {
  const auto client = greeted();
  client->say(kLoad);
  serve();
  client->say(kStatus);
  serve();
  EXPECT_FALSE(server_->stop_waits());
  client->say(kStop);
  serve();
  EXPECT_TRUE(server_->stop_waits());
  EXPECT_EQ(handled_, std::vector{ControlVerb::load}) << "nothing overtakes";
  server_->answer_late(ControlFields{});
  for (int i = 0; i < 3; ++i) serve();
  EXPECT_EQ(handled_.back(), ControlVerb::stop);
  EXPECT_EQ(client->heard().size(), 3U);
}

TEST_F(ControlServing, WhoHangsUpWhileHeWaitsIsForgotten) {
  const auto client = greeted();
  client->say(kLoad);
  serve();
  ASSERT_EQ(server_->clients(), 1U);
  client->hang_up();
  for (int i = 0; i < 3; ++i) serve();
  EXPECT_EQ(server_->clients(), 0U);
  server_->answer_late(ControlFields{});  // to nobody
}

TEST_F(ControlServing, WhoWatchesIsToldAndCanNotAsk) {
  const auto client = greeted();
  client->say(kWatch);
  serve();
  ASSERT_EQ(client->heard().size(), 1U);
  client->say(kStop);
  server_->publish("state", {{"state", std::string("armed")}});
  serve();
  const auto heard = client->heard();
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_NE((heard[0] + heard[1]).find("who watches can't ask"), std::string::npos);
  EXPECT_NE((heard[0] + heard[1]).find("armed"), std::string::npos);
  EXPECT_EQ(handled_, std::vector{ControlVerb::watch}) << "the stop was not carried out";
}

}  // namespace
}  // namespace tacto::playback
