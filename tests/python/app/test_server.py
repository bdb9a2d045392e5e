"""The server of the page: who may ask what, how much, and what it sends; without a browser."""

from __future__ import annotations

import base64
import http.client
import json
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

from nacre.app import server as module
from nacre.app.answer import Stopped, _recent, answer
from nacre.app.cards import cards
from nacre.app.server import HEADERS, MOST_BYTES, MOST_PAGES, Server, open_server
from nacre.case import templates
from support import Capture, Patch, command

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")

Reply = tuple[int, dict[str, str], bytes]
JSON = {"Content-Type": "application/json"}


@pytest.fixture
def server() -> Iterator[Server]:
    """Yield a server on a port of its own."""
    one = Server(0, cards())
    thread = threading.Thread(target=one.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True)
    thread.start()
    yield one
    one.is_open = False
    one.shutdown()
    one.server_close()


def ask(server: Server, method: str, path: str, *body: bytes | str, **headers: str) -> Reply:
    """Return code, headers and body of the answer to a request below the secret."""
    return raw(server, method, server.root + path, *body, **headers)


def raw(server: Server, method: str, path: str, body: bytes | str = b"", **headers: str) -> Reply:
    """Return code, headers and body of the answer to a request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=60)
    names = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, names)
    reply = connection.getresponse()
    content = reply.read()
    connection.close()
    return reply.status, dict(reply.getheaders()), content


def question(**changed: Any) -> str:
    """Return a question on the ball, with changes."""
    first = {"card": "contact", "values": {}, "stage": "draft", "page": "p", "age": 1}
    return json.dumps(first | changed)


def post(server: Server, body: bytes | str, path: str = "/answer", **headers: str) -> Any:
    """Return code and answer of a question."""
    code, _, content = ask(
        server, "POST", path, body, **({"Content_Type": JSON["Content-Type"]} | headers)
    )
    return code, json.loads(content) if code == 200 else content.decode()


def test_it_listens_on_this_computer_alone(server: Server) -> None:
    assert server.server_address[0] == "127.0.0.1"
    assert server.socket.getsockname()[0] == "127.0.0.1"


@pytest.mark.parametrize(
    ("path", "kind"),
    [("/", "text/html"), ("/page.js", "text/javascript"), ("/page.css", "text/css")],
)
def test_three_files_are_sent(server: Server, path: str, kind: str) -> None:
    code, headers, content = ask(server, "GET", path)
    assert code == 200
    assert headers["Content-Type"] == f"{kind}; charset=utf-8"
    assert len(content) > 1000


@pytest.mark.parametrize(
    "path",
    [
        *(
            "/page.html",
            "/index.html",
            "/static/page.js",
            "/../page.js",
            "/..%2fpage.js",
        ),
        *(
            "/page.js/..",
            "/answer",
            "/report",
            "/?a=1",
            "/page.js?v=1",
            "/etc/passwd",
            "/%00",
            "page.js",
        ),
    ],
)
def test_all_other_paths_are_unknown(server: Server, path: str) -> None:
    assert ask(server, "GET", path)[0] == 404


@pytest.mark.parametrize("path", ["/", "/page.js", "/answer/", "/save", "/../answer"])
def test_all_other_questions_are_unknown(server: Server, path: str) -> None:
    assert post(server, question(), path)[0] == 404


def test_without_the_secret_there_is_no_page(server: Server) -> None:
    own = server.root
    assert len(own) > 40
    assert server.url == f"http://127.0.0.1:{server.server_port}{own}/"
    for root in ("", own[:-1], f"{own}x", own.swapcase(), "/%C3%A4", f"/x{own}"):
        codes = [raw(server, "GET", root + path)[0] for path in ("/", "/page.js", "/page.css")]
        assert codes == [404] * 3
        assert (
            raw(server, "POST", f"{root}/answer", question(), Content_Type=JSON["Content-Type"])[0]
            == 404
        )
    with Server(0, {}) as other:
        assert other.root != own


def test_the_address_of_the_browser_leads_to_the_page_once(server: Server) -> None:
    path = server.url_once.partition(str(server.server_port))[2]
    assert raw(server, "GET", path, Host="evil.example")[0] == 400
    code, headers, _ = raw(server, "GET", path)
    assert (code, headers["Location"]) == (303, f"{server.root}/")
    assert raw(server, "GET", path)[0] == 404


def test_many_connections_at_once_do_not_wait(server: Server) -> None:
    for _ in range(2):
        start = time.monotonic()
        for _ in range(40):
            socket.create_connection(("127.0.0.1", server.server_port)).close()
        if (longest := time.monotonic() - start) < 0.9:
            return
    raise AssertionError(f"40 connections took {longest:.1f} s")


@pytest.mark.parametrize("method", ["PUT", "DELETE", "OPTIONS", "HEAD", "PATCH", "TRACE"])
def test_other_methods_are_refused(server: Server, method: str) -> None:
    assert ask(server, method, "/")[0] == 501


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{}", "127.0.0.1", "127.0.0.2:{}", ""]
)
def test_other_hosts_are_refused(server: Server, host: str) -> None:
    host = host.format(server.server_port)
    assert ask(server, "GET", "/", Host=host)[0] == 400
    assert post(server, question(), Host=host)[0] == 400


def test_both_names_of_this_computer_are_known(server: Server) -> None:
    for name in ("127.0.0.1", "localhost"):
        own = f"{name}:{server.server_port}"
        assert ask(server, "GET", "/", Host=own, Origin=f"http://{own}")[0] == 200


@pytest.mark.parametrize(
    "origin", ["null", "http://evil.example", "https://127.0.0.1:{}", "http://127.0.0.1:1", ""]
)
def test_other_origins_are_refused(server: Server, origin: str) -> None:
    code, text = post(server, question(), Origin=origin.format(server.server_port))
    assert (code, text) == (403, "Origin must be this page")


@pytest.mark.parametrize(
    "kind", ["", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data"]
)
def test_forms_of_other_sites_are_refused(server: Server, kind: str) -> None:
    assert post(server, question(), Content_Type=kind)[0] == 400


def test_large_questions_are_refused(server: Server) -> None:
    assert post(server, b"", Content_Length=str(MOST_BYTES + 1))[0] == 413
    assert post(server, b"", Content_Length="9" * 40)[0] == 413
    assert post(server, b"", Content_Length="-1")[0] == 411


def test_questions_without_a_length_are_refused(server: Server) -> None:
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=10) as line:
        head = f"POST {server.root}/answer HTTP/1.1\r\nHost: 127.0.0.1:{server.server_port}\r\n"
        line.sendall(f"{head}Content-Type: application/json\r\n\r\n".encode())
        assert line.recv(100).startswith(b"HTTP/1.1 411")


@pytest.mark.parametrize(
    "body",
    [
        *(b"", b"{", b"\xff\xfe", b"[]", b'"x"', b"1", b'{"age": NaN}', b"[" * 60_000),
        question(stage="report").encode(),
        question(stage="other").encode(),
        question(card="own").encode(),
        question(card="../contact").encode(),
        question(values=[1]).encode(),
        question(age="1").encode(),
        question(age=True).encode(),
    ],
)
def test_what_is_no_question_is_refused(server: Server, body: bytes) -> None:
    assert post(server, body)[0] == 400


@pytest.mark.parametrize(
    "value", ["nan", "inf", "1e999", "", None, True, [1], {"a": 1}, "<b>", "1e7"]
)
def test_wrong_numbers_are_answers_that_name_the_field(server: Server, value: object) -> None:
    code, reply = post(server, question(values={"solve.load": value}))
    assert code == 200
    assert reply["field"] == "solve.load"
    assert reply["error"].startswith("load must be between 0.001 and 1000000 N, got ")


@pytest.mark.parametrize(
    "path", ["shape.path", "sweep.store", "solve.threads", "__class__", "x" * 999]
)
def test_only_fields_of_the_card_are_set(server: Server, path: str) -> None:
    code, reply = post(server, question(values={path: "1"}))
    assert code == 200
    assert "is not a field of this card" in reply["error"]


def test_every_answer_has_the_headers(server: Server) -> None:
    for method, path in (
        ("GET", "/"),
        ("GET", "/page.js"),
        ("GET", "/x"),
        ("POST", "/x"),
        ("PUT", "/"),
    ):
        headers = ask(server, method, path)[1]
        assert {name: headers.get(name) for name in HEADERS} == HEADERS
        assert "Python" not in headers["Server"]


def test_the_policy_allows_nothing_from_elsewhere_and_nothing_inline() -> None:
    policy = HEADERS["Content-Security-Policy"]
    assert policy.startswith("default-src 'none'; script-src 'self'; style-src 'self'")
    assert "unsafe" not in policy
    assert "*" not in policy


def test_the_page_has_no_script_style_or_address_of_its_own(server: Server) -> None:
    page = ask(server, "GET", "/")[2].decode()
    assert re.findall(r"<script[^>]*>(.*?)</script>", page) == [""]
    assert not re.search(r"<style|\sstyle=|\son\w+=", page)
    tags = re.sub(r'data-source="[^"]*"', "", page)  # of the materials, which are text
    assert re.findall(r'(?:src|href)="([^"]*)"', tags) == ["data:,", "page.css", "page.js"]
    script = ask(server, "GET", "/page.js")[2].decode()
    assert "http" not in script
    assert "eval" not in script.replace("interval", "")


def test_every_field_has_a_label(server: Server) -> None:
    page = ask(server, "GET", "/")[2].decode()
    names = re.findall(r'<(?:input|select) id="([^"]*)"', page)
    assert len(names) == len(set(names)) > 60
    assert set(re.findall(r'<label for="([^"]*)"', page)) == set(names)
    sliders = re.findall(r'<input type="range"[^>]*>', page)
    assert all("aria-label=" in slider for slider in sliders)


def test_a_question_has_an_answer(server: Server) -> None:
    code, reply = post(server, question(values={"solve.load": "40"}))
    assert code == 200
    assert reply["next"] == "full"
    assert reply["parts"]["peak"][1].split()[2] == "MPa"
    code, reply = post(server, question(stage="case"))
    assert "[solve]" in reply["case"]


def test_a_report_has_an_answer(server: Server) -> None:
    code, reply = post(server, question(card="indentation", stage="report"), "/report")
    assert code == 200
    assert reply["report"].startswith("<!doctype html>")
    assert "<script" not in reply["report"]


def test_an_older_question_is_given_up(server: Server, monkeypatch: Patch) -> None:
    calls = threading.Event()

    def slow(case: object, stage: object, going: Any, *others: object) -> dict[str, bool]:
        calls.set()
        while going():
            time.sleep(0.01)
        raise Stopped

    monkeypatch.setattr(module, "answer", slow)
    replies = []
    first = threading.Thread(target=lambda: replies.append(post(server, question(stage="full"))))
    first.start()
    assert calls.wait(10)
    monkeypatch.undo()
    post(server, question(age=2))
    first.join(10)
    assert replies == [(200, {"stopped": True})]


def test_drafts_do_not_wait_for_other_answers(server: Server, monkeypatch: Patch) -> None:
    going = threading.Event()
    going.set()

    def slow(case: Any, stage: str, *others: Any) -> dict[str, Any]:
        while stage != "draft" and going.is_set():
            time.sleep(0.01)
        return answer(case, "draft", *others)

    monkeypatch.setattr(module, "answer", slow)
    threads = [
        threading.Thread(target=post, args=(server, question(stage="full", page=str(k))))
        for k in range(5)
    ]
    for thread in threads:
        thread.start()
    code, reply = post(server, question(page="other"))
    assert (code, reply["next"]) == (200, "full")
    assert all(thread.is_alive() for thread in threads)
    going.clear()
    for thread in threads:
        thread.join(30)


def test_a_long_answer_ends_in_a_sentence(server: Server, monkeypatch: Patch) -> None:
    monkeypatch.setattr(module, "SECONDS", 0.0)
    code, reply = post(server, question(stage="full"))
    assert code == 200
    assert "computes for more than" in reply["error"]


def test_a_busy_machine_ends_no_answer(server: Server, monkeypatch: Patch) -> None:
    """Time that others take, and that an answer waits, is not counted."""
    times = iter([0.0, 1.0, 2.0, 31.5, 60.0, 62.1])
    monkeypatch.setattr(time, "process_time", lambda: next(times))
    _, is_wanted = server.going("one", 1)
    server.running = 1
    assert is_wanted()
    assert is_wanted()
    assert is_wanted()
    server.running = 2  # of the next 58 s half are another's
    assert is_wanted()
    with pytest.raises(ValueError, match="computes for more than 30 s"):
        is_wanted()
    server.running = 0


@pytest.mark.parametrize(
    "fault", [OverflowError("far\ntoo large"), KeyboardInterrupt(), {"parts": float("nan")}]
)
def test_whatever_fails_is_an_answer_and_a_line(
    server: Server, monkeypatch: Patch, capsys: Capture, fault: Any
) -> None:
    monkeypatch.setattr(module, "answer", mock.Mock(side_effect=[fault]))
    code, reply = post(server, question())
    assert code == 200
    assert reply["error"].startswith("nacre failed: ")
    error = capsys.readouterr().err
    assert error.startswith("nacre: ")
    assert error.count("\n") == 1
    monkeypatch.undo()
    assert "parts" in post(server, question(age=2))[1]


@pytest.mark.parametrize("value", ["1e300", "2", "-1e308"])
@pytest.mark.parametrize("card", ["line", "roller", "contact"])
def test_numbers_of_materials_are_checked_before_they_are_used(
    server: Server, card: str, value: str
) -> None:
    paths = [path for path in cards()[card].by_path if path.endswith(".poisson")]
    for path in paths:
        code, reply = post(server, question(card=card, values={path: value}))
        assert code == 200
        assert "poisson must be above -1 and at most 0.5" in reply["error"]


def test_few_pages_are_remembered(server: Server) -> None:
    for k in range(3 * MOST_PAGES):
        server.going(str(k), k)
    assert len(server.newest) == MOST_PAGES


def test_nothing_is_read_or_written(server: Server, monkeypatch: Patch) -> None:
    post(server, question())  # what is imported late
    post(server, question(card="indentation", stage="report"), "/report")

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("a file was opened")

    monkeypatch.setattr("builtins.open", refuse)
    monkeypatch.setattr("io.open", refuse)
    monkeypatch.setattr("os.open", refuse)
    for path, stage in (("/answer", "draft"), ("/answer", "case"), ("/report", "report")):
        code, reply = post(server, question(card="indentation", stage=stage), path)
        assert (code, reply.get("error")) == (200, None)


def test_nothing_of_a_file_is_kept(server: Server) -> None:
    text = templates.texts()["contact"].encode()
    contents = {"mine.toml": base64.b64encode(text).decode()}
    files = {"contents": contents, "reading": {}}
    reply = post(server, question(card="own", stage="open", files=files))[1]
    assert 'name="own"' in reply["form"]
    code, reply = post(server, question(card="own", files=files))
    assert (code, "parts" in reply) == (200, True)
    assert _recent.cache_info().currsize == 0
    assert "own" not in server.cards
    wrong: list[dict[str, Any]] = [{"card": "contact"}, {"files": []}, {"files": None}, {"more": 1}]
    for changed in wrong:
        refused = {"card": "own", "files": files} | changed
        assert post(server, question(**refused))[0] == 400
    empty = post(server, question(card="own", stage="open", files={}))[1]
    assert empty["error"] == "files must be sent as the page sends them"


def test_a_port_that_is_taken_is_passed_over(server: Server) -> None:
    other = open_server(server.server_port, cards())
    assert server.server_port < other.server_port < server.server_port + 10
    other.server_close()


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node")
def test_the_script_is_javascript(server: Server, tmp_path: Path) -> None:
    path = tmp_path / "page.js"
    path.write_bytes(server.files["/page.js"][1])
    subprocess.run(["node", "--check", path], check=True, capture_output=True)


@pytest.mark.skipif(sys.platform == "win32", reason="a port would be shared there")
def test_a_port_with_connections_of_an_ended_program_is_free() -> None:
    ended = open_server(0, cards())
    with socket.create_connection(("127.0.0.1", ended.server_port)):
        request, _ = ended.get_request()
        request.shutdown(socket.SHUT_RDWR)
        request.close()
        ended.server_close()
        again = open_server(ended.server_port, cards())
        assert again.server_port == ended.server_port
        again.server_close()


def test_without_a_free_port_there_is_a_line(
    server: Server, monkeypatch: Patch, capsys: Capture
) -> None:
    monkeypatch.setattr(module, "PORTS", 1)
    assert command("app", "--no-browser", "--port", server.server_port) == 2
    assert "--port: none of" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "words"),
    [("x = ", "not a TOML file"), ("[solve]\nload = 1", "missing"), (None, "No such file")],
)
def test_a_wrong_case_is_a_line(
    text: str | None, words: str, tmp_path: Path, capsys: Capture
) -> None:
    path = tmp_path / "case.toml"
    if text is not None:
        path.write_text(text)
    assert command("app", path, "--no-browser") == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1


def test_there_is_no_other_address(capsys: Capture) -> None:
    assert command("app", "--host", "0.0.0.0") == 2
    assert "--host" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Windows reach the whole console")
def test_ctrl_c_ends_at_once() -> None:
    line = "import nacre.cli; nacre.cli.main(['app', '--no-browser'])"
    arguments = [sys.executable, "-c", line]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        words = ""
        while "Ctrl-C" not in words:
            words = process.stdout.readline()
        port, root = re.findall(r":(\d+)(/\S+)/;", words)[0]
        connection = http.client.HTTPConnection("127.0.0.1", int(port), timeout=60)
        connection.request("POST", f"{root}/answer", question(card="bearing", stage="full"), JSON)
        time.sleep(0.5)  # it solves
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        assert process.wait(20) == 130
        assert time.monotonic() - start < 2
        connection.close()
