"""Opens a page in headless Chromium and prints, as JSON, what a reader finds in it.

Usage: look_at_page.py PAGE [SCREENSHOT]
       look_at_page.py ANIMATION.png    how many different pictures are seen in the first seconds
"""

import json
import pathlib
import sys
import tempfile
import time

from selenium.webdriver.support.ui import WebDriverWait

from browser import browser, requests

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
