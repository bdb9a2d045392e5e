"""The server of the page: on this computer alone, without state, by Python's own `http.server`."""

from __future__ import annotations

import json
import math
import secrets
import sys
import threading
import time
import traceback
import warnings
from collections import OrderedDict
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from socketserver import TCPServer
from typing import Any

import nacre
from nacre.app.answer import STAGES, Answer, Going, Stopped, answer, forget
from nacre.app.cards import Card
from nacre.app.fields import FieldError
from nacre.app.line import filled, with_note
from nacre.app.opened import LARGEST, Asks, opened_card
from nacre.app.page import files, opened
from nacre.case import CaseError

ADDRESS = "127.0.0.1"
PORTS = 10
"""Number of ports that are tried."""
MOST_BYTES = 64 * 1024 + 4 * (LARGEST // 3 + 1)
"""Largest size of a question, whose files are in base64."""
MOST_PAGES = 64
"""Number of pages whose newest question is known."""
LANE = 2
"""Number of drafts, and of other answers, at a time."""
SECONDS = 30.0
"""Longest time that an answer computes, and that a connection has no question."""
QUESTION = {"card": str, "values": dict, "stage": str, "page": str, "age": int}
"""Parts of a question, and their types."""
WITH_FILES = QUESTION | {"files": dict}
"""Those of a question on files."""
STAGES_AT = {"/answer": (*STAGES, "case", "line", "open"), "/report": ("report",)}
"""Stages that may be asked for, by path."""
HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}


class Refused(Exception):
    """A request that is refused: the code of HTTP, and why."""


class Server(ThreadingHTTPServer):
    """Server of the page with some cards."""

    daemon_threads = True
    block_on_close = False
    request_queue_size = 128  # with http.server's 5, some quick connections wait a second
    allow_reuse_address = sys.platform != "win32"  # where it would share a port that is taken

    def __init__(self, port: int, cards: Mapping[str, Card]) -> None:
        super().__init__((ADDRESS, port), Handler)
        self.cards = cards
        self.files = files(cards)
        self.root = f"/{secrets.token_urlsafe()}"
        self.once = [f"/{secrets.token_urlsafe()}/"]
        self.hosts = {f"{name}:{self.server_port}" for name in (ADDRESS, "localhost")}
        self.newest: OrderedDict[str, float] = OrderedDict()
        self.lock = threading.Lock()
        self.lanes = {True: threading.Semaphore(LANE), False: threading.Semaphore(LANE)}
        self.running = 0
        self.is_open = True

    @property
    def url(self) -> str:
        """Address of the page, which nobody guesses."""
        return f"http://{ADDRESS}:{self.server_port}{self.root}/"

    @property
    def url_once(self) -> str:
        """Address that leads to the page once: other accounts see how a browser is started."""
        return f"http://{ADDRESS}:{self.server_port}{self.once[0]}"

    def path_below(self, path: str) -> str:
        """Return what follows the secret of a path, or nothing."""
        root, rest = path[: len(self.root)], path[len(self.root) :]
        return rest if secrets.compare_digest(root.encode(), self.root.encode()) else ""

    def server_bind(self) -> None:
        """Bind the port, without looking up the name of this computer."""
        TCPServer.server_bind(self)
        self.server_name, self.server_port = ADDRESS, self.server_address[1]

    def handle_error(self, request: object, client_address: object) -> None:
        """Say nothing of a page that has gone, and of all else what failed."""
        if not isinstance(error := sys.exception(), OSError | None):
            _log(error)

    def going(self, page: str, age: float) -> tuple[Going, Going]:
        """Return two functions that say whether a question is still the newest of its page.

        The second one counts the time of the processors, of which answers at a time have equal
        parts, and raises an error where it is too long: a busy machine ends no answer.
        """
        with self.lock:
            self.newest[page] = max(age, self.newest.pop(page, age))
            if len(self.newest) > MOST_PAGES:
                self.newest.popitem(last=False)
        last, spent = math.inf, 0.0

        def is_newest() -> bool:
            return self.is_open and self.newest.get(page, age) <= age

        def is_wanted() -> bool:
            nonlocal last, spent
            now = time.process_time()
            spent += max(now - last, 0.0) / max(self.running, 1)
            last = now
            if spent >= SECONDS:
                raise CaseError(f"this computes for more than {SECONDS:g} s: choose a smaller case")
            return is_newest()

        return is_newest, is_wanted

    def reply(self, question: Mapping[str, Any]) -> Answer:
        """Return the answer to a question."""
        stage, sent = question["stage"], question.get("files")
        is_newest, going = self.going(question["page"][:60], question["age"])
        values = dict(question["values"])
        text = str(values.pop("line", ""))
        try:
            card = opened_card(sent) if sent is not None else self.cards[question["card"]]
            if stage == "open":
                return {**opened(card)}
            if stage == "line":
                return filled(text, self.cards, card.name)._asdict()
            case, measured = card.case(values), with_note(text, values, card)
            with self.lane(stage == "draft", is_newest):
                return answer(case, stage, going, measured, card.shown)
        except Asks as error:
            return {"error": str(error), "ask": error.what}
        except FieldError as error:
            return {"error": str(error), "field": error.path}
        except (LookupError, ValueError) as error:
            return {"error": " ".join(str(error).split())}
        except Stopped:
            return {"stopped": True}
        finally:
            if sent is not None:  # nothing of these files is kept
                forget()

    def content(self, question: Mapping[str, Any]) -> bytes:
        """Return the answer to a question as JSON; whatever fails is an answer, too."""
        try:
            return json.dumps(self.reply(question), allow_nan=False).encode()
        except BaseException as error:  # the panics of Rust are no Exception
            _log(error)
            sentence = f"nacre failed: {type(error).__name__}; see the terminal for details"
            return json.dumps({"error": sentence}).encode()

    @contextmanager
    def lane(self, is_draft: bool, going: Going) -> Iterator[None]:
        """Wait until there is room: drafts never wait for other answers."""
        lane = self.lanes[is_draft]
        while not lane.acquire(timeout=0.05):
            if not going():
                raise Stopped
        try:
            with self.lock:
                self.running += 1
            yield
        finally:
            with self.lock:
                self.running -= 1
            lane.release()


class Handler(BaseHTTPRequestHandler):
    """Requests: three files and two questions."""

    server: Server
    protocol_version, server_version, sys_version = "HTTP/1.1", "nacre", ""
    timeout = SECONDS

    def do_GET(self) -> None:
        """Send a file of the page, or the answer to a question."""
        try:
            code, (kind, body) = 200, self._content()
        except Refused as refusal:
            code, (kind, body) = refusal.args[0], ("text/plain", refusal.args[1].encode())
            self.close_connection = True  # the rest of the request is not read
        self.send_response(code)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(body)))
        if code == 303:
            self.send_header("Location", f"{self.server.root}/")
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(body)

    do_POST = do_GET

    def _content(self) -> tuple[str, bytes]:
        """Return type and content of what was asked for; what another site asks is refused."""
        if self.headers.get("Host") not in self.server.hosts:
            raise Refused(400, "Host must be that of this page")
        origin = self.headers.get("Origin")
        if origin is not None and origin.removeprefix("http://") not in self.server.hosts:
            raise Refused(403, "Origin must be this page")
        path = self.server.path_below(self.path)
        if self.command == "GET" and path in self.server.files:
            return self.server.files[path]
        if self.command == "POST" and path in STAGES_AT:
            question = self._question(STAGES_AT[path])
            return "application/json", self.server.content(question)
        with suppress(ValueError):
            self.server.once.remove(self.path)
            raise Refused(303, "the page is elsewhere")
        raise Refused(404, "there is no such page: open the address that nacre app has printed")

    def _question(self, stages: Collection[str]) -> dict[str, Any]:
        """Return the question in the body of a request."""
        if self.headers.get_content_type() != "application/json":
            raise Refused(400, "Content-Type must be application/json")
        length = self.headers.get("Content-Length", "")
        if not (length.isascii() and length.isdigit()):
            raise Refused(411, "Content-Length is missing")
        if int(length[:9]) > MOST_BYTES or len(length) > 9:
            raise Refused(413, f"a question has at most {MOST_BYTES} bytes")
        try:
            # NaN and infinities, which are no JSON, are no integers either.
            question = json.loads(self.rfile.read(int(length)), parse_constant=int)
        except (ValueError, RecursionError):
            raise Refused(400, "a question is JSON") from None
        if not (
            isinstance(question, dict)
            and {key: type(value) for key, value in question.items()} in (QUESTION, WITH_FILES)
            and (
                question["card"] == "own"
                if "files" in question
                else question["card"] in self.server.cards
            )
            and question["stage"] in stages
        ):
            raise Refused(400, "no such question")
        return question

    def end_headers(self) -> None:
        """Send the headers that every answer has."""
        for name, value in HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def log_message(self, format: str, *args: object) -> None:
        """Write no log."""


def _log(error: BaseException) -> None:
    """Write a line on an error that nobody expected, and where it was raised."""
    *_, (path, line, name, _) = traceback.extract_tb(error.__traceback__)
    print(f"nacre: {path}:{line}, {name}: {error!r:.300}", file=sys.stderr, flush=True)


def open_server(port: int, cards: Mapping[str, Card]) -> Server:
    """Return a server on a port, or on the first free one of those after it."""
    warnings.simplefilter("ignore", nacre.NacreWarning)  # answers have them
    for candidate in range(port, min(port + PORTS, 65536)):
        try:
            return Server(candidate, cards)
        except OSError as error:
            reason = error
    raise CaseError(f"--port: none of {port} to {port + PORTS - 1} is free: {reason.strerror}")
