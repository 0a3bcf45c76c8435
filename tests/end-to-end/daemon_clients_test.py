#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The clients of tactographd: wrong lines, crowds, permissions and tokens, and clients that leave while the device is armed."""
import contextlib
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time

import tacto
from run_daemon import begin, Client, daemon, DAEMON, expect_a_soft_fall, other_config, prepare_files, SLOW, UNSUITABLE, USAGE, write_token

CLOSED, SILENT = "the client that armed has closed its connection", "no line came from the client that armed"


def garbage_and_endless_lines():
    prepare_files()
    with daemon():
        client = Client(greet=False)
        assert "hello" in client.ask(request="status")["error"]["remedy"]
        answer = client.ask(request="hello", version="2.0")
        assert not answer["ok"] and "2.0" in answer["error"]["what"]
        client.must(request="hello", version="1.0")
        for line in (b"\xff\xfe\x00nothing\n", b"{}\n", b"[" * 5000 + b"\n", b'{"request":"fly"}\n', b'{"request":"gain"}\n',
                     b'{"request":"load","file":7}\n', b"\n"):
            client.socket.sendall(line)
            answer = json.loads(client.lines.readline())
            assert not answer["ok"] and answer["error"]["what"], (line, answer)
        assert client.ask(request="status", id=7)["id"] == 7
        answer = client.ask(request="gain", gain=5000)
        assert "from -1000" in answer["error"]["remedy"] and "factor" in answer["error"]["remedy"], answer
        endless = Client()
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            endless.socket.sendall(b"x" * 1_000_000)
        with contextlib.suppress(ConnectionResetError):
            assert "16384 bytes" in endless.lines.readline()
        client.must(request="status")


def many_requests_at_once():
    """Requests sent in one piece are all answered, in order, including a `stop` at the end; also if the client closes
    its sending side."""
    prepare_files()
    lines = "".join(json.dumps({"request": "gain", "gain": 0.5, "id": i}) + "\n" for i in range(70)) + '{"request":"stop","id":70}\n'
    with daemon():
        client = Client()
        begin(client)
        client.socket.sendall(lines.encode())
        answers = [json.loads(client.lines.readline()) for _ in range(71)]
        assert [a["id"] for a in answers] == list(range(71)) and all(a["ok"] for a in answers), answers
        client.wait_for("armed")
        half = Client()
        half.socket.sendall(lines.encode())
        half.socket.shutdown(socket.SHUT_WR)
        # After that the daemon closes the connection.
        assert [json.loads(line)["id"] for line in half.lines] == list(range(71))
        client.must(request="disarm")
        silent = Client()  # the same if nothing plays, and the client does not read
        silent.socket.sendall(lines.encode())
        silent.socket.close()
        client.must(request="status")


def a_thousand_clients():
    """Clients above the limit get an error; those that play continue to play."""
    prepare_files(most_clients=8)
    with daemon():
        client = Client()
        begin(client)
        crowd = []
        for _ in range(1000):
            one = socket.socket(socket.AF_UNIX)
            one.settimeout(10)
            one.connect("control")
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                one.sendall(b'{"request":"hello","version":"1.0"}\n')
            one.setblocking(False)
            crowd.append(one)
            if len(crowd) % 50 == 0:
                client.must(request="status")
        for _ in range(20):
            client.must(request="status")
        refused = 0
        for one in crowd:
            with contextlib.suppress(BlockingIOError, OSError):
                refused += b'"ok":false' in one.recv(4096).replace(b" ", b"")
        assert refused > 950, refused
        tacto.run("ctl", "status", "--socket", "control", code=5)  # the error of the daemon
        assert "armed" in tacto.run("ctl", "stop", "--socket", "control")[0]
        client.must(request="play")
        for one in crowd:
            one.close()
        status = client.must(request="status")
        assert status["state"] == "playing" and status["lost_ticks"] == 0, status
        client.must(request="disarm")
    print(f"1000 connected, {refused} refused")


def permissions():
    prepare_files()
    with daemon():
        assert os.stat("control").st_mode & 0o777 == 0o600
        if os.geteuid() == 0:
            os.chmod(".", 0o755)
            done = subprocess.run(["setpriv", "--reuid", "65534", "--clear-groups", tacto.COMMAND, "ctl", "status", "--socket",
                                   "control"], capture_output=True, text=True)
            assert done.returncode == 3 and "control" in done.stderr, done
    prepare_files(socket_group="no-such-group")
    second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
    assert second.returncode == 2 and "no-such-group" in second.stderr, second
    prepare_files(device_=1)
    second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
    assert second.returncode == 4 and "device_" in second.stderr, second


def by_tcp_with_a_token():
    """127.0.0.1 only; without the token nothing, not even a second request; unauthenticated clients cannot take all
    places."""
    token = "0123456789abcdef"
    prepare_files(tcp_port=0, tcp_token_file="token", most_clients=8, files=".")
    write_token(token + "\n")
    with daemon() as process:
        port = int(process.ready.rsplit(":", 1)[1])
        newer = Client(greet=False, port=port).ask(request="hello", version="2.0")
        assert not newer["ok"] and "uses version 2.0" in newer["error"]["what"] and "token" not in json.dumps(newer), newer
        for first in ({"request": "status"}, {"request": "hello", "version": "1.0"},
                      {"request": "hello", "version": "1.0", "token": token[:-1]},
                      {"request": "hello", "version": "1.0", "token": token + "0"}):
            stranger = Client(greet=False, port=port)
            answer = stranger.ask(**first)
            assert not answer["ok"] and "tcp_token_file" in answer["error"]["remedy"], answer
            assert stranger.lines.readline() == "", "hung up on"
        browser = Client(greet=False, port=port)
        browser.socket.sendall(b'POST / HTTP/1.1\r\nHost: localhost\r\n\r\n{"request":"stop"}\n')
        assert not json.loads(browser.lines.readline())["ok"]
        with contextlib.suppress(ConnectionResetError):
            assert browser.lines.readline() == "", "hung up on at the first line"
        client = Client(port=port, token=token)
        begin(client)
        silent = [Client(greet=False, port=port) for _ in range(5)]  # four may be without the token
        assert Client().must(request="status")["state"] == "playing"
        said = [json.loads(one.lines.readline())["error"]["fault"] for one in silent]
        assert said == [UNSUITABLE] + 4 * [USAGE], said  # too many; no hello came
        assert client.wait_for("playing"), "who says nothing goes after 5 s"
        client.must(request="disarm")
        addresses = subprocess.run(["ss", "-Hltn", f"sport = :{port}"], capture_output=True, text=True) if shutil.which("ss") else None
        assert addresses is None or f"127.0.0.1:{port}" in addresses.stdout and "0.0.0.0:%d" % port not in addresses.stdout, addresses
        second = subprocess.run([DAEMON, "--config", other_config(socket="other", tcp_port=port)], capture_output=True, text=True, timeout=20)
        assert second.returncode == 5 and f"tcp_port {port}" in second.stderr, second
    for text, mode, words in ((token, 0o644, "chmod 600"), ("short", 0o600, "/dev/urandom"), (None, 0, "/dev/urandom")):
        pathlib.Path("token").unlink(missing_ok=True)
        if text is not None:
            write_token(text, mode)
        second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
        assert second.returncode != 0 and words in second.stderr, second
    prepare_files(tcp_port=0)
    second = subprocess.run([DAEMON, "--config", "tactographd.json"], capture_output=True, text=True, timeout=20)
    assert second.returncode == 4 and "tcp_token_file" in second.stderr, second


def silent_clients_do_not_keep_stop_out():
    """Clients that send nothing, or only hello, take all sixteen places: `stop` is accepted nevertheless."""
    prepare_files()
    for greets in (False, True):
        with daemon():
            client = Client()
            begin(client)
            crowd = [Client(greet=greets) for _ in range(15 + 10)]
            assert "armed" in tacto.run("ctl", "stop", "--socket", "control")[0]
            client.wait_for("armed")
            assert "idle" in tacto.run("ctl", "disarm", "--socket", "control")[0]
            assert client.must(request="status")["state"] == "idle"
            del crowd


def arm_while_connected(client, **members):
    client.must(request="load", file="oak", gain_m_per_n=0.0005)
    session = client.must(request="arm", while_connected=True, **members)["session"]
    client.must(request="play")
    client.wait_for("playing")
    return session


def whoever_armed_goes_away():
    """By closing the socket, by Unix and TCP: the drive falls, states and status have the reason, the session is
    closed, and the next client may arm. If another client leaves, nothing changes."""
    prepare_files(tcp_port=0, tcp_token_file="token", files=".")
    write_token("0123456789abcdef")
    with daemon() as process:
        port = int(process.ready.rsplit(":", 1)[1])
        other, watcher = Client(), Client()
        watcher.must(request="watch")
        for how in ({}, {"port": port, "token": "0123456789abcdef"}):
            client, passing = Client(**how), Client()
            session = arm_while_connected(client)
            assert other.must(request="status")["while_connected"]
            passing.must(request="gain", gain=0.9)
            passing.socket.close()
            passing.lines.close()
            time.sleep(0.5)
            assert other.must(request="status")["state"] == "playing"
            client.socket.close()
            client.lines.close()
            assert other.wait_for("idle")["why"] == CLOSED
            expect_a_soft_fall(session, CLOSED)
        states = [(e["state"], e["why"]) for e in watcher.rest_of_events() if e["event"] == "state"]
        assert states == 2 * [("armed", ""), ("playing", ""), ("armed", CLOSED), ("idle", CLOSED)], states
        client = Client()
        begin(client)
        client.socket.close()
        client.lines.close()
        time.sleep(0.5)
        assert other.must(request="status")["state"] == "playing", "without while_connected it goes on"
        other.must(request="disarm")


def whoever_armed_is_silent():
    """dead_man_s: the shorter one of request and configuration applies. Any line of the client that armed resets it;
    without while_connected a line of any client."""
    prepare_files(dead_man_s=1)
    with daemon():
        client, other = Client(), Client()
        session = arm_while_connected(client, dead_man_s=30)
        assert other.must(request="status")["dead_man_s"] == 1
        for _ in range(20):
            client.ask(request="nonsense")
            time.sleep(0.1)
        assert other.must(request="status")["state"] == "playing"
        assert SILENT in other.wait_for("idle")["why"], "others' lines do not count"
        expect_a_soft_fall(session, SILENT)
        session = begin(client)
        for _ in range(20):
            other.must(request="status")
            time.sleep(0.1)
        assert other.must(request="status")["state"] == "playing"
        time.sleep(1.5 * SLOW)
        assert "no line came from any client for 1 s" in other.wait_for("idle")["why"]
        expect_a_soft_fall(session, "no line came from any client")


def play_that_is_watched():
    """`ctl play --watch` plays as long as it runs: Ctrl-C, SIGKILL and SIGSTOP each end it, and so does its time."""
    prepare_files()
    command = [tacto.COMMAND, "ctl", "play", "--watch", "--socket", "control"]
    with daemon():
        client = Client()
        client.must(request="load", file="oak", gain_m_per_n=0.0005)
        for how, why in ((signal.SIGKILL, CLOSED), (signal.SIGSTOP, SILENT), (signal.SIGINT, ""), (None, "")):
            more = ["--json"] if how else ["--json", "--time", "1s"]
            play = subprocess.Popen([*command, *more], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            status = client.wait_for("playing")
            assert status["while_connected"] and status["dead_man_s"] == 2, status
            time.sleep(0.5)
            if how:
                play.send_signal(how)
            status = client.wait_for("idle", seconds=10)
            assert status.get("why", "").startswith(why) and ("why" in status) == bool(why), status
            if how == signal.SIGSTOP:
                play.send_signal(signal.SIGCONT)
            out, said = play.communicate(timeout=20)
            assert play.returncode == (-signal.SIGKILL if how == signal.SIGKILL else 0), (play.returncode, out, said)
            if how != signal.SIGKILL:
                assert json.loads(out)["state"] == "idle" and json.loads(out)["played_s"] > 0.3, out
            if why:
                expect_a_soft_fall(status["session"], why)
        session = begin(client)
        play = subprocess.run(command, capture_output=True, text=True, timeout=20)
        assert play.returncode == 2 and "playing" in play.stderr, play
        assert client.must(request="status")["session"] == session
        client.must(request="disarm")


TESTS = [garbage_and_endless_lines, many_requests_at_once, a_thousand_clients, permissions, by_tcp_with_a_token,
         silent_clients_do_not_keep_stop_out, whoever_armed_goes_away, whoever_armed_is_silent, play_that_is_watched]

if __name__ == "__main__":
    for test in TESTS:
        if len(sys.argv) < 2 or test.__name__ in sys.argv[1:]:
            tacto.in_folder(test)
