"""Chromium without a window, for the scripts that look at pages."""

import json
import pathlib

from selenium import webdriver
from selenium.webdriver.chrome.service import Service


def browser(profile, flags=("disable-gpu", "window-size=1280,900")):
    """Chromium without a window and without a word to the network of its own."""
    options = webdriver.ChromeOptions()
    for flag in [
        "headless", "no-sandbox", "disable-quic", "no-first-run", "disable-background-networking",
        "disable-component-update", "disable-sync", "disable-dev-shm-usage", f"user-data-dir={profile}", *flags,
    ]:
        options.add_argument(f"--{flag}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    # Named by hand, so that selenium looks for no driver on the network.
    places = map(pathlib.Path, ["/usr/bin/chromedriver", "/usr/local/bin/chromedriver"])
    driver = next(path for path in places if path.exists())
    return webdriver.Chrome(options=options, service=Service(str(driver)))


def requests(driver, own=("data:", "file:")):
    """Addresses that the page asked for, those that begin as its own apart."""
    events = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
    sent = [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
    return [address for address in sent if not address.startswith(tuple(own))]
