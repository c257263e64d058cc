"""What the tests in this folder share: the program, a folder for pictures, and a browser that may not use the network."""

import os
import subprocess
from pathlib import Path

import pytest
from playwright.sync_api import Error as PlaywrightError
from playwright.sync_api import sync_playwright

# A browser that draws in software and keeps to itself.
ARGUMENTS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # Containers give /dev/shm 64 MB, less than a picture of a long page needs.
    "--disable-dev-shm-usage",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]


@pytest.fixture(scope="session")
def regrasp():
    """Runs the program with these words and gives its standard output; another exit code than 0 fails the test."""
    program = os.environ["REGRASP"]

    def run(*words, cwd=None):
        done = subprocess.run([program, *map(str, words)], cwd=cwd, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def pictures():
    """Where pictures are kept for a person to look at."""
    folder = Path(os.environ["OUTSIDE"])
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@pytest.fixture(scope="session")
def keep_picture(pictures):
    """Keeps what a page's window shows under this name, for a person to look at.

    No test asks anything of these pictures. Software rendering on a busy machine now and then has no frame ready in time
    ("Unable to capture screenshot"): it is asked again.
    """

    def keep(page, name, attempts=5):
        for left in reversed(range(attempts)):
            try:
                page.screenshot(path=pictures / name)
                return
            except PlaywrightError:
                if not left:
                    raise
                page.wait_for_timeout(500)

    return keep


@pytest.fixture(scope="session")
def browser():
    """Debian's chromium without a window."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=ARGUMENTS)
        yield browser
        browser.close()


class Visit:
    """A page, and everything that it did beyond being looked at."""

    def __init__(self, page):
        self.page = page
        self.complaints = []
        self.requests = []
        page.on("console", lambda message: self.complaints.append(message.text) if message.type in ("error", "warning") else None)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", lambda request: self.requests.append(request.url))

    def foreign_requests(self, path):
        """Requests for anything but the page itself and what it holds."""
        own = Path(path).resolve().as_uri()
        return [url for url in self.requests if url != own and not url.startswith(("data:", "blob:"))]


@pytest.fixture
def visit(browser):
    """Opens a file as a page: `visit(path, width=…, height=…, color_scheme=…)`."""
    contexts = []

    def open_page(path, width=1200, height=900, color_scheme="light", **options):
        context = browser.new_context(viewport={"width": width, "height": height}, color_scheme=color_scheme, **options)
        contexts.append(context)
        visit = Visit(context.new_page())
        visit.page.goto(Path(path).resolve().as_uri())
        return visit

    yield open_page
    for context in contexts:
        context.close()
