// SPDX-License-Identifier: GPL-3.0-or-later
// The places at the control socket with more clients than places: `stop` always gets one. And connections
// without the token: their number, and the delay after a wrong one.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "playback/control/control_server.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/playback/socket_client.hpp"

namespace tacto::playback {
namespace {

using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;
using namespace tests;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kPlaces = 4;
constexpr const char* kToken = "0123456789abcdef";

std::string hello_with(const std::string& token, const char* version = "1.0") {
  return std::string(R"({"request":"hello","version":")") + version + R"(","token":")" + token + "\"}\n";
}

class ControlPlaces : public testing::Test {
 protected:
  using Client = std::unique_ptr<SocketClient>;

  void serve(int times = 1) {
    for (int i = 0; i < times; ++i)
      server_->serve(0, [this](const ControlRequest& request) -> ControlServer::Answer {
        handled_.push_back(request.verb);
        return ControlFields{};
      });
  }
  // On this machine a connection by a Unix socket, and data sent on it, arrive at once; by TCP they may take
  // time.
  template <class Done>
  void serve_until(const Done& done) {
    for (int i = 0; i < 100'000 && !done(); ++i) serve();
  }
  Client connected() {
    auto client = std::make_unique<SocketClient>(path_);
    serve();
    return client;
  }
  Client by_tcp(const std::string& says = {}) {
    auto client = std::make_unique<SocketClient>(server_->tcp_port());
    const std::size_t before = server_->clients();
    serve_until([&] { return server_->clients() > before; });
    if (!says.empty()) client->say(says);
    return client;
  }
  std::string answer_of(SocketClient& client) {
    std::vector<std::string> heard;
    serve_until([&] { return !(heard = client.heard()).empty(); });
    return heard.empty() ? "" : heard.front();
  }
  std::vector<Client> crowd(int count, bool greets) {
    std::vector<Client> clients;
    for (int i = 0; i < count; ++i) {
      clients.push_back(connected());
      if (greets) clients.back()->say(kHello);
      serve(2);
      if (greets) clients.back()->heard();
    }
    return clients;
  }
  bool stopped() {
    SocketClient client(path_);
    client.say(std::string(kHello) + kStop);
    serve(4);
    return client.heard().size() == 2 && handled_.back() == ControlVerb::stop;
  }

  tests::TemporaryFolder folder_;
  std::string path_ = folder_ / "control";
  std::chrono::steady_clock::time_point now_{};
  std::unique_ptr<ControlServer> server_ = ControlServer::listen({.path = path_,
                                                                  .group = "",
                                                                  .most_clients = kPlaces,
                                                                  .loopback = LoopbackPlace{0, kToken},
                                                                  .now = [this] { return now_; }})
                                               .value();
  std::vector<ControlVerb> handled_;
};

TEST_F(ControlPlaces, AStopIsTakenWhereAllPlacesAreTaken) {
  for (const bool greets : {false, true}) {
    const auto silent = crowd(kPlaces, greets);
    EXPECT_TRUE(stopped()) << greets;
  }
}

TEST_F(ControlPlaces, AStopIsTakenInACrowdThatConnectsAgainAndAgain) {
  const auto silent = crowd(kPlaces, true);
  std::vector<Client> more;
  for (int i = 0; i < 50; ++i) {
    for (int j = 0; j < 20; ++j) more.push_back(std::make_unique<SocketClient>(path_));
    serve();
  }
  SocketClient client(path_);
  client.say(std::string(kHello) + kStop);
  serve_until([&] { return !handled_.empty() && handled_.back() == ControlVerb::stop; });
  EXPECT_EQ(handled_.back(), ControlVerb::stop);
  more.push_back(connected());
  serve();
  EXPECT_LE(server_->clients(), kPlaces + 8U + 2U) << "kept places are few";
}

TEST_F(ControlPlaces, AKeptPlaceIsForStopAndDisarmOnly) {
  const auto silent = crowd(kPlaces, true);
  SocketClient client(path_);
  client.say(std::string(kHello) + kStatus);
  serve(4);
  const auto heard = client.heard();
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_NE(heard[1].find("4 clients"), std::string::npos) << heard[1];
  EXPECT_EQ(server_->clients(), static_cast<std::size_t>(kPlaces)) << "it is disconnected";
}

TEST_F(ControlPlaces, AKeptPlaceEndsAfterFiveSeconds) {
  const auto silent = crowd(kPlaces, true);
  const auto late = connected();
  now_ += milliseconds(5001);
  serve();
  EXPECT_NE(answer_of(*late).find("4 clients"), std::string::npos);
  EXPECT_EQ(server_->clients(), static_cast<std::size_t>(kPlaces));
}

TEST_F(ControlPlaces, WhoSaidNoHelloWithinFiveSecondsGoesFirst) {
  auto silent = crowd(1, false);
  const auto greeted = crowd(kPlaces - 1, true);
  now_ += seconds(4);
  const auto early = connected();
  EXPECT_TRUE(silent[0]->heard().empty()) << "there is time left";
  now_ += seconds(1);
  const auto next = connected();
  const auto heard = silent[0]->heard();
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_NE(heard[0].find("5 s"), std::string::npos) << heard[0];
  next->say(std::string(kHello) + kStatus);
  serve(4);
  EXPECT_EQ(handled_.back(), ControlVerb::status) << "it has a place for everything";
  for (const Client& one : greeted) EXPECT_TRUE(one->heard().empty());
}

TEST_F(ControlPlaces, WhoIsInAKeptPlaceGetsOneThatBecomesFree) {
  auto greeted = crowd(kPlaces, true);
  SocketClient client(path_);
  serve(2);
  greeted.pop_back();
  serve(2);
  client.say(std::string(kHello) + kStatus);
  serve(4);
  EXPECT_EQ(handled_.back(), ControlVerb::status);
}

TEST_F(ControlPlaces, AStrangerOfAnotherVersionIsToldOfTheVersion) {
  const auto client = by_tcp(R"({"request":"hello","version":"2.0"})"
                             "\n");
  const std::string answer = answer_of(*client);
  EXPECT_NE(answer.find(R"("fault":5)"), std::string::npos) << answer;
  EXPECT_EQ(answer.find("token"), std::string::npos) << answer;
  serve_until([&] { return server_->clients() == 0; });
  EXPECT_EQ(server_->clients(), 0U) << "and is disconnected";
}

TEST_F(ControlPlaces, AWrongTokenIsAnsweredAfterASecondAndARightOneAtOnce) {
  const auto wrong = by_tcp(hello_with("wrong"));
  EXPECT_NE(answer_of(*by_tcp(hello_with(kToken))).find("\"ok\":true"), std::string::npos);
  serve_until([&] { return server_->clients() == 1; });  // the other one has disconnected
  EXPECT_EQ(server_->clients(), 1U);
  now_ += milliseconds(999);
  serve(2);
  EXPECT_TRUE(wrong->heard().empty());
  now_ += milliseconds(1);
  const std::string answer = answer_of(*wrong);
  EXPECT_NE(answer.find("tcp_token_file"), std::string::npos);
  serve();
  EXPECT_EQ(server_->clients(), 0U);
  EXPECT_NE(answer, answer_of(*by_tcp(kHello))) << "a wrong token is another error than none";
}

TEST_F(ControlPlaces, OneThatIsSilentByTcpGetsTheRemedyWithTheToken) {
  const auto silent = by_tcp();
  now_ += seconds(6);
  EXPECT_NE(answer_of(*silent).find("tcp_token_file"), std::string::npos);
}

TEST_F(ControlPlaces, FourConnectionsMayBeWithoutTheToken) {
  std::vector<Client> silent;
  for (int i = 0; i < 4; ++i) silent.push_back(by_tcp());
  serve(2);
  EXPECT_EQ(server_->clients(), 4U);
  const auto fifth = by_tcp();
  EXPECT_NE(answer_of(*silent.front()).find("have not given the token"), std::string::npos)
      << "the oldest goes";
  EXPECT_EQ(server_->clients(), 4U);
  fifth->say(hello_with(kToken));
  EXPECT_NE(answer_of(*fifth).find("\"ok\":true"), std::string::npos);
  const auto sixth = by_tcp();
  serve(2);
  EXPECT_EQ(server_->clients(), 5U) << "three silent, one new, one with the token";
  EXPECT_TRUE(silent[1]->heard().empty());
}

TEST_F(ControlPlaces, ConnectionsWithoutTheTokenKeepNoRightOneOut) {
  std::vector<Client> others;
  for (int i = 0; i < 10; ++i) others.push_back(by_tcp(i % 2 == 0 ? hello_with("wrong") : std::string()));
  serve(10);
  EXPECT_LE(server_->clients(), 4U);
  const auto right = by_tcp(hello_with(kToken) + kStatus);
  std::vector<std::string> heard;
  serve_until([&] {
    for (const std::string& line : right->heard()) heard.push_back(line);
    return heard.size() == 2;
  });
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_NE(heard[1].find("\"ok\":true"), std::string::npos) << heard[1];
  EXPECT_EQ(handled_.back(), ControlVerb::status);
}

TEST_F(ControlPlaces, LinesAreCountedByClientAndOfAll) {
  const auto one = connected(), other = connected();
  one->say(std::string(kHello) + kStatus);
  serve(3);
  const LinesReceived of_all = server_->lines_received(std::nullopt);
  other->say("what?\n");
  serve(3);
  EXPECT_EQ(server_->lines_received(std::nullopt).lines, of_all.lines) << "who said no hello does not count";
  EXPECT_EQ(server_->lines_received(1).lines, 2U);
  one->say("what?\n");
  serve(3);
  EXPECT_EQ(server_->lines_received(1).lines, 3U) << "any line counts";
  EXPECT_EQ(server_->lines_received(std::nullopt).lines, of_all.lines + 1);
  EXPECT_TRUE(server_->lines_received(1).connected);
  one->hang_up();
  serve(2);
  EXPECT_FALSE(server_->lines_received(1).connected);
}

}  // namespace
}  // namespace tacto::playback
