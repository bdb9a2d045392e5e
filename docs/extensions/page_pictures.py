"""Take the pictures of the page of `nacre app`: python docs/extensions/page_pictures.py.

It needs Chromium of the system, and writes docs/images/app-*.png.
"""

from __future__ import annotations

import shutil
import threading
from pathlib import Path

from playwright.sync_api import sync_playwright

from nacre.app.cards import cards
from nacre.app.server import Server

IMAGES = Path(__file__).parents[1] / "images"


def main() -> None:
    """Solve each card in a window of 1280 px, and take its picture."""
    server = Server(0, cards())
    threading.Thread(target=server.serve_forever, daemon=True).start()
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium, args=["--no-sandbox"]
        )
        for card in ("bearing", "contact", "indentation"):
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(f"{server.url}#card={card}")
            page.wait_for_selector('[data-testid="status"][data-state="done"]')
            page.screenshot(path=IMAGES / f"app-{card}.png", full_page=True)
        browser.close()
    server.shutdown()


if __name__ == "__main__":
    main()
