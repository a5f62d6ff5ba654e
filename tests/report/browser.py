"""A headless Chromium that shows pages from disk and tells what they did."""

import json
from pathlib import Path
from types import TracebackType
from typing import Any

from selenium import webdriver

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
PHONE, DESK = 375, 1440  # CSS pixels


class Browser:
    """One session; each page that is shown is written into its folder."""

    def __init__(self, chromium: str, driver: str, folder: Path):
        options = webdriver.ChromeOptions()
        options.binary_location = chromium
        for flag in (*FLAGS, f"--user-data-dir={folder / 'profile'}"):
            options.add_argument(flag)
        logs = {"browser": "ALL", "performance": "ALL"}
        options.set_capability("goog:loggingPrefs", logs)
        service = webdriver.ChromeService(driver)
        self._driver = webdriver.Chrome(options=options, service=service)
        self._folder = folder

    def __enter__(self) -> "Browser":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._driver.quit()

    def show(self, html: str, width: int = DESK, scheme: str = "light") -> None:
        """Open a page at a width and in a colour scheme; earlier logs are dropped."""
        path = self._folder / "page.html"
        path.write_text(html, encoding="utf-8")
        self._command(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=900,
            deviceScaleFactor=1,
            mobile=width == PHONE,
        )
        wanted = [{"name": "prefers-color-scheme", "value": scheme}]
        self._command("Emulation.setEmulatedMedia", media="", features=wanted)
        self.console(), self.requests()
        self._driver.get(path.as_uri())

    def media(self, kind: str) -> None:
        """Show the page as on another medium: print or screen."""
        self._command("Emulation.setEmulatedMedia", media=kind)

    def run(self, script: str) -> Any:
        """What a script on the page returns."""
        return self._driver.execute_script(script)

    def press(self, element: str, *keys: str) -> None:
        """Send keys to the element with this id, as a user at the keyboard does."""
        self._driver.find_element("id", element).send_keys(*keys)

    def choose(self, element: str, value: str) -> None:
        """Choose an option of a list by its value."""
        self.run(
            f"const list = document.getElementById({element!r});"
            f"list.value = {value!r};"
            "list.dispatchEvent(new Event('change', {bubbles: true}));"
        )

    def console(self) -> list[str]:
        """Messages since they were last asked for."""
        return [entry["message"] for entry in self._driver.get_log("browser")]

    def requests(self) -> list[str]:
        """Addresses that were asked for since they were last asked for."""
        events = [
            json.loads(entry["message"])["message"]
            for entry in self._driver.get_log("performance")
        ]
        return [
            event["params"]["request"]["url"]
            for event in events
            if event["method"] == "Network.requestWillBeSent"
        ]

    def _command(self, name: str, **arguments: Any) -> None:
        self._driver.execute_cdp_cmd(name, arguments)
