// SPDX-License-Identifier: GPL-3.0-or-later
// The order of answers of the control socket to clients that send much, wait, leave, or have no permission.
#include "playback/control/control_server.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "playback/control/control_connection.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/playback/socket_client.hpp"

namespace tacto::playback {
namespace {

using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;
using namespace tests;

std::string again(const char* line, int times) {
  std::string lines;
  for (int i = 0; i < times; ++i) lines += line;
  return lines;
}

class ControlServing : public testing::Test {
 protected:
  // A `load` is answered later, everything else at once.
  void serve(int timeout_ms = 0) {
    server_->serve(timeout_ms, [this](const ControlRequest& request) -> ControlServer::Answer {
      handled_.push_back(request.verb);
      if (request.verb == ControlVerb::load) return std::nullopt;
      return ControlFields{};
    });
  }
  std::unique_ptr<SocketClient> greeted() {
    auto client = std::make_unique<SocketClient>(path_);
    client->say(kHello);
    for (int i = 0; i < 3; ++i) serve();
    EXPECT_EQ(client->heard().size(), 1U);
    handled_.clear();
    return client;
  }

  tests::TemporaryFolder folder_;
  std::string path_ = folder_ / "control";
  std::unique_ptr<ControlServer> server_ =
      ControlServer::listen({.path = path_, .group = "", .most_clients = 8, .loopback = {}}).value();
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
  server_->answer_late(ControlFields{});  // to a client that has left
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
  EXPECT_NE((heard[0] + heard[1]).find(R"("fault":1)"), std::string::npos);
  EXPECT_NE((heard[0] + heard[1]).find("armed"), std::string::npos);
  EXPECT_EQ(handled_, std::vector{ControlVerb::watch}) << "the stop was not carried out";
}

TEST_F(ControlServing, WhoDoesNotReadLosesNoChangeOfState) {
  const auto client = greeted();
  client->say("{\"request\":\"watch\",\"ticks\":true}\n");
  serve();
  client->heard();
  for (int i = 0; i < 3000; ++i)  // more than between two serve(), and 3 MB
    server_->publish(i % 2 == 0 ? "ticks" : "status", {{"ticks", std::string(1000, 'A')}});
  server_->publish("state", {{"state", std::string("playing")}});
  serve();
  for (int i = 0; i < 500; ++i) server_->publish("ticks", {{"ticks", std::string(1000, 'A')}});
  server_->publish("state", {{"state", std::string("armed")}});
  std::vector<std::string> states;
  std::size_t others = 0;
  for (int i = 0; i < 200; ++i) {
    serve();
    for (const std::string& line : client->heard())
      line.find("\"state\"") != std::string::npos ? states.push_back(line) : void(++others);
  }
  EXPECT_LT(others, 1500U);
  ASSERT_EQ(states.size(), 2U);
  EXPECT_NE(states[0].find("playing"), std::string::npos);
  EXPECT_NE(states[1].find("armed"), std::string::npos);
}

TEST_F(ControlServing, TicksAreForThoseWhoAskedForThem) {
  const auto plain = greeted(), curious = greeted();
  plain->say(kWatch);
  serve();
  EXPECT_FALSE(server_->ticks_watched());
  curious->say("{\"request\":\"watch\",\"ticks\":true}\n");
  serve();
  EXPECT_TRUE(server_->ticks_watched());
  EXPECT_EQ(plain->heard().size() + curious->heard().size(), 2U);
  server_->publish("ticks", {{"ticks", std::string("AAAA")}});
  server_->publish("status", {});
  serve();
  EXPECT_EQ(plain->heard().size(), 1U);
  EXPECT_EQ(curious->heard().size(), 2U);
  curious->hang_up();
  serve();
  serve();
  EXPECT_FALSE(server_->ticks_watched());
}

// Ctrl-C during a request for the status: `ctl play --watch` has to get the answer, and then to ask for the
// stop.
TEST_F(ControlServing, ASignalDoesNotEndTheWaitForAnAnswer) {
  struct sigaction handler = {}, before = {};
  handler.sa_handler = [](int) {};  // without SA_RESTART: poll() ends with EINTR
  ASSERT_EQ(sigaction(SIGUSR1, &handler, &before), 0);
  std::atomic<bool> done = false, answered = false;
  std::thread client([&] {
    auto connection = ControlConnection::open(path_);
    ControlRequest request;
    request.verb = ControlVerb::status;
    answered = connection && connection->ask(request);
    done = true;
  });
  while (!done)
    server_->serve(5, [&](const ControlRequest& request) -> ControlServer::Answer {
      for (int i = 0; request.verb == ControlVerb::status && i < 5; ++i) {
        pthread_kill(client.native_handle(), SIGUSR1);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      return ControlFields{{"version", std::string(schema::kControlVersion)}};
    });
  client.join();
  sigaction(SIGUSR1, &before, nullptr);
  EXPECT_TRUE(answered);
}

}  // namespace
}  // namespace tacto::playback
