"""The page in Chromium: typed values, sliders, links, files, lost connections.

Left out where the system has no Chromium.
"""

from __future__ import annotations

import datetime
import hashlib
import json
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright import sync_api

from nacre.app import server as server_module
from nacre.app.answer import answer
from nacre.app.cards import cards, own_card
from nacre.app.server import Server
from nacre.case import templates
from support import Capture, Patch, command

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)

pytestmark = [
    pytest.mark.browser,
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium of the system"),
    pytest.mark.filterwarnings("ignore"),
]

SECONDS = 300_000
"""Longest time of an answer, far above that on a busy machine [ms]."""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Yield Chromium."""
    with sync_api.sync_playwright() as playwright:
        one = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield one
        one.close()


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    """Yield the address of a server in this process."""
    server = Server(0, cards())
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    yield server.url
    server.is_open = False
    server.shutdown()
    server.server_close()


class Opened:
    """A page, and what it logs and asks for elsewhere."""

    def __init__(self, browser: Any, url: str, link: str = "", **options: Any) -> None:
        self.context = browser.new_context(accept_downloads=True, **options)
        self.page = self.context.new_page()
        self.page.set_default_timeout(SECONDS)
        self.logged: list[str] = []
        self.elsewhere: list[str] = []
        self.stages: list[str] = []
        self.page.on("console", lambda message: self.logged.append(message.text))
        self.page.on("pageerror", lambda error: self.logged.append(str(error)))
        self.page.on("request", self._asked)
        self.page.route(re.compile(r"^\w+://(?!127\.0\.0\.1:)"), lambda route: route.abort())
        self.url = url
        self.page.goto(url + link)

    def _asked(self, request: Any) -> None:
        if not request.url.startswith((self.url, "blob:", "data:")):
            self.elsewhere.append(request.url)
        if request.url.endswith("/answer"):
            self.stages.append(json.loads(request.post_data)["stage"])

    def at(self, name: str) -> Any:
        return self.page.locator(f'[data-testid="{name}"]:visible')

    def type(self, path: str, text: str) -> None:
        self.at(f"field:{path}").fill(text)

    def wait(self, *states: str) -> str:
        """Wait for a state, and return the main number."""
        for state in states or ("done",):
            self.page.wait_for_selector(f'[data-testid="status"][data-state="{state}"]')
        return str(self.at("peak").text_content())

    def close(self) -> None:
        """Close the page, which logged nothing and asked for nothing elsewhere."""
        self.context.close()
        assert self.logged == []
        assert self.elsewhere == []


@pytest.fixture
def opened(browser: Any, url: str) -> Iterator[Opened]:
    """Yield the page with the indentation, which is the fastest."""
    one = Opened(browser, url, "#card=indentation")
    one.wait()
    yield one
    one.close()


def saved(page: Opened, button: str, folder: Path) -> Path:
    """Return the file that a button saves."""
    with page.page.expect_download() as download:
        page.at(button).click()
    path = folder / str(download.value.suggested_filename)
    download.value.save_as(path)
    return path


@pytest.mark.parametrize("name", ["bearing", "contact", "indentation", "wear"])
def test_numbers_are_those_of_the_saved_case(
    browser: Any, url: str, name: str, tmp_path: Path, capsys: Capture
) -> None:
    page = Opened(browser, url)
    page.at(f"card:{name}").click()
    value, unit = page.wait().split()
    path = saved(page, "case-file", tmp_path)
    assert command("solve", path, "--json") == 0
    numbers = json.loads(capsys.readouterr().out)
    if name == "indentation":
        expected, in_case = 1e3 * max(numbers["approach"]), "nm"
    else:
        peaks = numbers.get("peak_pressures", [[numbers.get("peak_pressure")]])
        peaks = [[numbers["peak_pressure"][-1]]] if name == "wear" else peaks
        expected, in_case = max(map(max, peaks)), "MPa"
    assert unit == in_case
    assert float(value) == float(f"{expected:.5g}")
    page.close()


def test_a_number_with_a_unit_is_shown_as_it_was_typed(opened: Opened) -> None:
    before = opened.at("peak").text_content()
    field = opened.at("field:indent.load")
    default, slider = field.input_value(), opened.at("slider:indent.load")
    place, unit = slider.input_value(), field.locator("xpath=../*[@class='unit']")
    assert unit.is_visible()
    opened.type("indent.load", f"{float(default) * 1e-3!r} N")  # of mN
    assert opened.wait() == before
    assert field.input_value() == f"{float(default) * 1e-3!r} N"
    assert unit.is_hidden()  # the text has its own
    assert slider.input_value() == place
    opened.type("indent.load", "5 GPa")
    opened.wait("failed")
    assert re.search(r"mN, got 5 GPa", str(opened.at("error").text_content()))
    opened.type("indent.load", default)
    assert opened.wait() == before
    assert unit.is_visible()


def test_a_drag_ends_at_the_last_value_with_one_full_solve(opened: Opened) -> None:
    opened.stages.clear()
    # The clock of the page stands still: no rest is long enough for a full solve during the drag.
    opened.page.clock.install()
    opened.page.clock.pause_at(datetime.datetime.now() + datetime.timedelta(hours=1))
    slider = opened.at("slider:indent.load")
    box = slider.bounding_box()
    middle = box["y"] + box["height"] / 2
    opened.page.mouse.move(box["x"] + box["width"] / 2, middle)
    opened.page.mouse.down()
    for k in range(60):
        opened.page.mouse.move(box["x"] + box["width"] * (0.5 + k / 150), middle)
    opened.page.mouse.up()
    last = opened.at("field:indent.load").input_value()
    opened.wait("draft")
    assert opened.stages.count("full") == 0
    opened.page.clock.resume()
    peak = opened.wait()
    assert opened.stages.count("full") == 1
    assert float(last) > 5
    opened.type("indent.load", "1")
    opened.wait()
    opened.type("indent.load", last)
    assert opened.wait() == peak


def test_a_value_typed_right_after_solved_counts(browser: Any, url: str, opened: Opened) -> None:
    other = Opened(browser, url, "#card=indentation")
    other.wait()
    for k in range(20):
        for page, load in ((opened, 1 + k / 10), (other, 3 + k / 10)):
            page.type("indent.load", f"{load:g}")
        for page, load in ((opened, 1 + k / 10), (other, 3 + k / 10)):
            page.wait()
            assert f"<td>{load:g} mN</td>" in page.at("rows").inner_html()
    other.close()


def test_a_busy_browser_loses_no_value(opened: Opened) -> None:
    opened.page.evaluate("() => { const end = Date.now() + 9000; while (Date.now() < end); }")
    opened.type("indent.load", "2")
    opened.wait()
    assert "<td>2 mN</td>" in opened.at("rows").inner_html()


def process_at(port: int) -> subprocess.Popen[str]:
    """Return a program that serves the page."""
    secret = "import secrets; secrets.token_urlsafe = lambda: 'same'"
    line = (
        f"{secret}; import nacre.cli; nacre.cli.main(['app', '--no-browser', '--port', '{port}'])"
    )
    process = subprocess.Popen([sys.executable, "-c", line], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    while "Ctrl-C" not in process.stdout.readline():
        pass
    return process


def ended(process: subprocess.Popen[str]) -> None:
    """End a program."""
    process.kill()
    process.communicate(timeout=20)


@pytest.mark.skipif(sys.platform == "win32", reason="needs signals")
def test_a_program_that_is_stopped_or_started_again_loses_no_value(browser: Any) -> None:
    port = 8931
    process = process_at(port)
    page = Opened(browser, f"http://127.0.0.1:{port}/same/", "#card=indentation")
    try:
        page.wait()
        ended(process)
        page.type("indent.load", "2")
        time.sleep(1)
        process = process_at(port)
        page.wait()
        assert "<td>2 mN</td>" in page.at("rows").inner_html()
        process.send_signal(signal.SIGSTOP)
        page.type("indent.load", "3")
        time.sleep(9)
        process.send_signal(signal.SIGCONT)
        page.wait()
        assert "<td>3 mN</td>" in page.at("rows").inner_html()
    finally:
        ended(process)
        page.context.close()


def test_a_page_waits_for_its_program(browser: Any) -> None:
    process = process_at(port := 8951)
    page = Opened(browser, f"http://127.0.0.1:{port}/same/", "#card=indentation")
    try:
        page.wait()
        ended(process)
        page.type("indent.load", "2")
        page.wait("failed")
        assert page.at("error").text_content() == "the program no longer answers: start it again"
        process = process_at(port)
        page.wait()
        assert page.at("error").count() == 0
        assert "<td>2 mN</td>" in page.at("rows").inner_html()
    finally:
        ended(process)
        page.context.close()


def test_a_wrong_value_is_a_line_and_the_next_one_counts(opened: Opened) -> None:
    assert opened.at("error").count() == 0
    opened.type("indent.load", "-3")
    opened.wait("failed")
    assert opened.at("error").text_content() == (
        "largest load must be between 0.0001 and 1000 mN, got -3"
    )
    wrong = opened.page.locator("input:invalid")
    assert wrong.evaluate_all("inputs => inputs.map((one) => one.name)") == ["indent.load"]
    opened.type("indent.load", "1,5")
    opened.wait()
    assert (opened.at("error").count(), wrong.count()) == (0, 0)
    assert "<td>1.5 mN</td>" in opened.at("rows").inner_html()


def test_an_overflow_is_a_line_and_the_next_value_counts(browser: Any, url: str) -> None:
    page = Opened(browser, url, "#card=line&materials.steel.poisson=1e300")
    assert "poisson must be above -1" in page.at("error").text_content()
    page.at("more").locator("summary").click()
    page.type("materials.steel.poisson", "0.3")
    page.wait()
    assert page.at("error").count() == 0
    page.close()


def test_a_draft_that_goes_on_is_given_up(opened: Opened, monkeypatch: Patch) -> None:
    def slow(case: Any, stage: str, going: Any, *others: Any) -> dict[str, Any]:
        while case.data["indent"]["load"][-1] == 7000.0 and going():
            time.sleep(0.01)
        return answer(case, stage, going, *others)

    monkeypatch.setattr(server_module, "answer", slow)
    opened.type("indent.load", "7")
    time.sleep(0.5)
    start = time.monotonic()
    opened.type("indent.load", "2")
    opened.wait()
    assert time.monotonic() - start < 15  # not the half minute of an answer
    assert "<td>2 mN</td>" in opened.at("rows").inner_html()


def test_an_empty_limit_is_unknown(browser: Any, url: str) -> None:
    page = Opened(browser, url, "#card=line")
    page.wait()
    page.type("materials.steel.yield_stress", "")
    page.type("materials.coating.strength", "")
    page.wait()
    assert page.at("verdict").get_attribute("data-level") == "unknown"
    page.close()


def test_a_link_has_the_values(browser: Any, url: str, opened: Opened) -> None:
    opened.type("indent.load", "2.5")
    opened.type("body.layers[0].thickness", "800")
    peak = opened.wait()
    link = opened.page.url
    assert link.endswith("#card=indentation&load=2.5&thickness=800")
    page = Opened(browser, url, link.removeprefix(url) + "&bogus=<img src=x>")
    assert page.wait() == peak
    assert page.at("field:indent.load").input_value() == "2.5"
    assert "bogus" in page.page.locator(".note").text_content()
    assert page.page.locator("img").count() == 0
    page.close()


def test_the_report_has_the_number(opened: Opened, browser: Any, tmp_path: Path) -> None:
    path = saved(opened, "report", tmp_path)
    context = browser.new_context()
    asked: list[str] = []
    page = context.new_page()
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    assert [one for one in asked if not one.startswith(("file:", "data:"))] == []
    assert "The substrate shows" in page.inner_text("body")
    assert page.locator("svg").count() >= 1
    context.close()


@pytest.mark.parametrize(
    ("kind", "most"), [("contact", 1), ("ball-bearing", 1), ("roll", 1), ("pair", 2)]
)
def test_reports_are_short_on_paper(kind: str, most: int, browser: Any, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(templates.texts()[kind], encoding="utf-8")
    report = tmp_path / "case.html"
    assert command("solve", tmp_path / "case.toml", "--save", report) == 0
    page = browser.new_page()
    page.goto(report.as_uri())
    printed = page.pdf(prefer_css_page_size=True)
    page.close()
    assert 1 <= len(re.findall(rb"/Type\s*/Page\b", printed)) <= most


def test_markup_in_names_does_nothing(browser: Any, tmp_path: Path) -> None:
    bad = "<img src=x onerror=alert(1)>"
    text = templates.texts()["line"].replace("coating =", f'"{bad}" =', 1)
    path = tmp_path / "case.toml"
    text = text.replace('material = "coating"', f'material = "{bad}", name = "{bad}"', 1)
    path.write_text(text, encoding="utf-8")
    server = Server(0, {"own": own_card(path)})
    threading.Thread(target=server.serve_forever, daemon=True).start()
    page = Opened(browser, server.url, "#card=own")
    page.wait()
    assert bad in page.at("verdict").text_content()
    assert page.page.locator("img").count() == 0
    server.shutdown()
    server.server_close()
    page.close()


def test_the_keyboard_reaches_everything(opened: Opened) -> None:
    opened.page.locator("body").press("Tab")
    names = []
    for _ in range(30):
        focused = "document.activeElement"
        names.append(opened.page.evaluate(f"{focused}.dataset.testid ?? {focused}.className"))
        opened.page.keyboard.press("Tab")
    assert {"card:bearing", "report", "copy-link", "case-file", "variant"} <= set(names)
    assert {"field:indent.load", "slider:indent.load", "field:adhesion.work"} <= set(names)
    opened.at("slider:indent.load").focus()
    opened.page.keyboard.press("ArrowRight")
    opened.wait()
    assert float(opened.at("field:indent.load").input_value()) > 1


@pytest.mark.parametrize("width", [320, 400, 800, 1280])
def test_nothing_is_wider_than_the_window(browser: Any, url: str, width: int) -> None:
    for name in ("bearing", "contact", "indentation"):
        page = Opened(browser, url, f"#card={name}", viewport={"width": width, "height": 800})
        page.wait()
        page.at("more").locator("summary").click()
        assert page.page.evaluate("document.documentElement.scrollWidth") <= width
        page.close()


def test_a_material_fills_its_numbers(browser: Any, url: str) -> None:
    page = Opened(browser, url, "#card=line")
    page.wait()
    page.page.locator("select.material:visible").first.select_option("440C")
    page.wait()
    assert page.at("field:materials.steel.young").input_value() == "209.6"
    assert page.at("field:materials.steel.yield_stress").input_value() == "1896"
    assert "Rolled Alloys" in page.page.locator(".source:visible").text_content()
    assert "(card 440C)" in page.at("verdict").text_content()
    # A steel without a yield stress leaves that of the card in place again.
    page.page.locator("select.material:visible").first.select_option("100Cr6")
    page.wait()
    assert page.at("field:materials.steel.yield_stress").input_value() == "2000"
    assert "No yield stress of 100Cr6" in page.page.locator(".source:visible").text_content()
    page.type("materials.steel.young", "200")
    assert page.page.locator(".source:visible").count() == 0
    page.close()


def test_own_numbers_come_back(browser: Any, url: str) -> None:
    page = Opened(browser, url, "#card=line")
    page.wait()
    page.type("materials.steel.young", "203.5")
    menu = page.page.locator("select.material:visible").first
    menu.select_option("440C")
    assert page.at("field:materials.steel.young").input_value() == "209.6"
    menu.select_option("")
    assert page.at("field:materials.steel.young").input_value() == "203.5"
    assert page.at("field:materials.steel.yield_stress").input_value() == "2000"
    page.wait()
    page.close()


def test_an_error_has_no_word_of_the_values_before(opened: Opened) -> None:
    verdict = opened.at("verdict")
    before = verdict.get_attribute("data-level")
    assert before == "bad"
    opened.type("indent.load", "-3")
    opened.wait("failed")
    assert verdict.get_attribute("data-level") == ""
    assert verdict.inner_text().strip() == "No answer to these values."
    opened.type("indent.load", "1")
    opened.wait()
    assert verdict.get_attribute("data-level") == before


@pytest.mark.parametrize(
    ("typed", "key", "then"),
    [("12", "ArrowUp", "13"), ("1.50", "ArrowDown", "1.49"), ("2,5", "ArrowUp", "2.6")],
)
def test_arrow_keys_step_by_one_of_the_last_digit(
    opened: Opened, typed: str, key: str, then: str
) -> None:
    opened.type("indent.load", typed)
    opened.at("field:indent.load").press(key)
    assert opened.at("field:indent.load").input_value() == then
    opened.wait()
    assert f"<td>{then} mN</td>" in opened.at("rows").inner_html()


def test_the_history_of_the_browser_takes_back_changes(opened: Opened) -> None:
    peak = opened.wait()
    for path, text in (("indent.load", "2"), ("body.layers[0].thickness", "800")):
        opened.type(path, text)
        opened.wait()
    opened.page.go_back()
    assert opened.at("field:body.layers[0].thickness").input_value() == "1000"
    assert opened.at("field:indent.load").input_value() == "2"
    opened.at("report").focus()
    opened.page.keyboard.press("Control+z")
    opened.page.wait_for_function("location.hash === '#card=indentation'")
    assert opened.at("field:indent.load").input_value() == "1"
    assert opened.wait() == peak
    opened.page.go_forward()
    assert opened.at("field:indent.load").input_value() == "2"
    opened.wait()


def test_an_unknown_card_is_said(browser: Any, url: str) -> None:
    page = Opened(browser, url, "#card=gear&load=3")
    page.wait("draft")
    assert "a card that is not known here: gear" in page.page.locator(".note").text_content()
    assert page.at("field:solve.load").input_value() == "20"
    page.close()


def test_prints_have_the_inputs(opened: Opened) -> None:
    hidden = "one => getComputedStyle(one).display === 'none'"
    opened.page.emulate_media(media="print")
    opened.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert opened.at("field:indent.load").is_visible()
    assert opened.at("verdict").is_visible()
    assert opened.page.locator("header").evaluate(hidden)
    assert opened.page.locator("details[open]").count() >= 1
    opened.page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert opened.page.locator("details[open]").count() == 0


def test_colours_follow_the_scheme(browser: Any, url: str) -> None:
    colours = set()
    for scheme in ("light", "dark"):
        page = Opened(browser, url, "#card=indentation", color_scheme=scheme)
        page.wait()
        for selector, name in (("body", "backgroundColor"), ("figure svg .paper", "fill")):
            colour = f"one => getComputedStyle(one).{name}"
            colours.add((selector, page.page.locator(selector).first.evaluate(colour)))
        page.close()
    assert len(colours) == 4


def test_cleanliness_is_chosen_from_words(browser: Any, url: str) -> None:
    page = Opened(browser, url, "#card=ball-bearing")
    page.wait()
    before = page.at("rows").inner_text()
    page.at("field:bearing.oil.cleanliness").select_option("severe contamination")
    page.wait()
    assert page.at("rows").inner_text() != before
    assert "cleanliness=severe+contamination" in page.page.url
    page.close()


def test_finer_cells_are_a_button(browser: Any, url: str) -> None:
    page = Opened(browser, url, "#card=contact")
    # A coat of rubber, a twentieth of a cell thick: its tension is below its error.
    page.type("body.layers[0].thickness", "0.1")
    page.type("materials.coating.young", "1")
    page.wait()
    assert 'press "Finer"' in page.at("warnings").text_content()
    page.at("finer").click()
    page.wait()
    assert page.page.locator('[data-testid="warnings"] li').count() == 0
    page.close()


def test_a_line_of_text_fills_the_card(browser: Any, url: str, tmp_path: Path) -> None:
    page = Opened(browser, url, "#card=bearing")
    page.wait()
    page.at("line").fill("6206, C 19,5 kN, C0 11,3 kN, Fr 2 kN, 3000/min, about 1 kN, 20000 h")
    page.at("line").press("Enter")
    sync_api.expect(page.page.locator(".note")).to_contain_text("about", timeout=SECONDS)
    page.wait()
    for path, text in {"count": "9", "diameter": "9.548", "solve.force.x": "2"}.items():
        assert page.at(f"field:bearing.{path}").input_value() == text
    assert "are estimates from the ratings" in str(page.at("warnings").text_content())
    assert "# estimated: 6206: count 9" in saved(page, "case-file", tmp_path).read_text("utf-8")
    again = Opened(browser, url, page.page.url.removeprefix(url))
    again.wait()
    assert "are estimates from the ratings" in str(again.at("warnings").text_content())
    again.type("bearing.diameter", "9.525")
    again.wait("busy", "done")
    assert "are estimates" not in str(again.at("warnings").text_content())
    again.close()
    page.close()


def test_files_are_opened_and_asked_about(opened: Opened, tmp_path: Path) -> None:
    page, error = opened.page, opened.page.locator(".error")
    heights = "\n".join(
        " ".join(str((i - 8) ** 2 + (k - 8) ** 2) for k in range(16)) for i in range(16)
    )
    path = tmp_path / "map.txt"
    path.write_text(heights, encoding="utf-8")
    page.locator("[type=file]").set_input_files(path)
    sync_api.expect(error).to_contain_text("kind must be chosen")
    opened.at("reading:kind").select_option("height_map")
    for key, text in {"unit": "nm", "spacing": "0.5 µm"}.items():
        opened.at(f"reading:{key}").fill(text)
        opened.at(f"reading:{key}").press("Enter")
    opened.page.wait_for_selector('[data-testid="card:own"]', timeout=SECONDS)
    opened.wait()
    assert error.is_hidden()
    assert page.locator("[data-reading]:visible").count() == 0
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    assert f"# map.txt: SHA-256 {digest}" in saved(opened, "case-file", tmp_path).read_text("utf-8")
    assert digest in saved(opened, "report", tmp_path).read_text("utf-8")
    opened.at("card:indentation").click()
    opened.wait()
    opened.at("card:own").click()  # is still there
    before = opened.wait()
    opened.type("solve.load", "1e-3")
    assert opened.wait("busy", "done") != before


def test_a_case_is_dropped_and_a_large_file_is_refused(opened: Opened, tmp_path: Path) -> None:
    text = templates.texts()["cone"]
    drop = opened.page.evaluate_handle(
        "text => { const list = new DataTransfer();"
        " list.items.add(new File([text], 'mine.toml')); return list; }",
        text,
    )
    opened.page.dispatch_event("main", "drop", {"dataTransfer": drop})
    opened.page.wait_for_selector('[data-testid="card:own"]', timeout=SECONDS)
    opened.wait()
    large = tmp_path / "large.npy"
    large.write_bytes(bytes(10_000_001))
    opened.page.locator("[type=file]").set_input_files(large)
    sync_api.expect(opened.page.locator(".error")).to_contain_text("at most 10 MB")
