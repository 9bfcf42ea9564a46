"""Opens a page in headless Chromium and prints, as JSON, what a reader finds in it.

Usage: look_at_page.py PAGE [SCREENSHOT]
       look_at_page.py ANIMATION.png    how many different pictures are seen in the first seconds
"""

import json
import pathlib
import sys
import tempfile
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

FIND = """
const seen = element => { const box = element.getBoundingClientRect(); return [box.width, box.height]; };
const images = figure => [...figure.querySelectorAll('img, svg')].map(image => ({
    size: seen(image),
    decoded: image.tagName !== 'IMG' || (image.complete && image.naturalWidth > 0),
    described: Boolean(image.alt || image.parentElement.getAttribute('aria-label')),
}));
return {
    title: document.title,
    figures: Object.fromEntries([...document.querySelectorAll('figure')].map(figure => [figure.id, images(figure)])),
    tables: [...document.querySelectorAll('table')].map(table => ({
        rows: table.tBodies[0].rows.length,
        numbers: [...table.querySelectorAll('tbody .number')].filter(cell => /[0-9]/.test(cell.textContent)).length,
    })),
    warnings: document.querySelectorAll('.warning').length,
    wider_than_the_window: document.documentElement.scrollWidth > window.innerWidth,
    background: getComputedStyle(document.body).backgroundColor,
    text: document.body.innerText,
};
"""

LOADED = "return location.protocol === 'file:' && document.readyState === 'complete';"

FOLLOW = """
const link = arguments[0];
link.click();
const target = document.getElementById(link.getAttribute('href').slice(1));
return target !== null && location.hash === link.getAttribute('href') && target.getBoundingClientRect().height > 0;
"""


def browser(profile):
    """Chromium without a window and without a word to the network of its own."""
    options = webdriver.ChromeOptions()
    for flag in [
        "headless", "no-sandbox", "disable-gpu", "disable-quic", "no-first-run", "disable-background-networking",
        "disable-component-update", "disable-sync", "disable-dev-shm-usage", "window-size=1280,900",
        f"user-data-dir={profile}",
    ]:
        options.add_argument(f"--{flag}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    # Named by hand, so that selenium looks for no driver on the network.
    driver = next(path for path in map(pathlib.Path, ["/usr/bin/chromedriver", "/usr/local/bin/chromedriver"]) if path.exists())
    return webdriver.Chrome(options=options, service=Service(str(driver)))


def requests(driver):
    """Addresses that the page asked for, itself apart."""
    events = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
    sent = [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
    return [address for address in sent if not address.startswith(("data:", "file:"))]


def watch(animation):
    """The number of different pictures that a viewer sees within three seconds."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        driver = browser(profile)
        try:
            driver.get(pathlib.Path(animation).resolve().as_uri())
            pictures, end = set(), time.monotonic() + 3
            while time.monotonic() < end:
                pictures.add(driver.get_screenshot_as_png())
        finally:
            driver.quit()
    return {"pictures": len(pictures)}


def main(page, screenshot=None):
    if page.endswith(".png"):
        json.dump(watch(page), sys.stdout)
        return
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        driver = browser(profile)
        try:
            # What the browser's own first tab says is no word of the page's.
            driver.get("about:blank")
            for log in ["browser", "performance"]:
                driver.get_log(log)
            driver.get(pathlib.Path(page).resolve().as_uri())
            # The driver may still hold the blank page, which is complete, for that which it waits for.
            WebDriverWait(driver, 60).until(lambda d: d.execute_script(LOADED))
            found = driver.execute_script(FIND)
            links = driver.find_elements("css selector", "nav a")
            found["links"] = {link.get_attribute("href").split("#")[-1]: driver.execute_script(FOLLOW, link) for link in links}
            dark = {"features": [{"name": "prefers-color-scheme", "value": "dark"}]}
            driver.execute_cdp_cmd("Emulation.setEmulatedMedia", dark)
            found["dark_background"] = driver.execute_script("return getComputedStyle(document.body).backgroundColor")
            found["complaints"] = [entry["message"] for entry in driver.get_log("browser")]
            found["requests"] = requests(driver)
            if screenshot:
                driver.save_screenshot(screenshot)
        finally:
            driver.quit()
    json.dump(found, sys.stdout)


main(*sys.argv[1:])
