"""Uses the viewer as a reader would, in headless Chromium with graphics in software, and prints, as JSON, what it did.

Usage: look_at_viewer.py ADDRESS [SCREENSHOT]
       look_at_viewer.py --follow ADDRESS    looks on while a run goes on, says `followed`, and waits for its end
"""

import json
import sys
import tempfile

from browser import browser, requests
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select, WebDriverWait

FLAGS = ["use-angle=swiftshader", "enable-unsafe-swiftshader", "window-size=1280,860"]

# Share of the canvas that is not white, and how many colours there are.
LOOK = """
const canvas = document.getElementById('canvas');
const copy = document.createElement('canvas');
[copy.width, copy.height] = [canvas.width, canvas.height];
const context = copy.getContext('2d');
context.drawImage(canvas, 0, 0);
const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
let inked = 0;
const colors = new Set();
for (const pixel of pixels) {
    if ((pixel & 0xffffff) !== 0xffffff) { inked += 1; colors.add(pixel); }
}
return { inked: inked / pixels.length, colors: colors.size };
"""

# The size of the picture that a reader saves, and whether the bar of colours is in it.
SAVE = """
const done = arguments[0];
HTMLAnchorElement.prototype.click = function () {
    const picture = new Image();
    picture.onload = () => {
        const canvas = document.createElement('canvas');
        [canvas.width, canvas.height] = [picture.width, picture.height];
        const context = canvas.getContext('2d');
        context.drawImage(picture, 0, 0);
        const stage = document.getElementById('canvas').getBoundingClientRect();
        const bar = document.querySelector('#colorbar canvas').getBoundingClientRect();
        const [x, y] = [bar.left - stage.left + bar.width / 2, bar.top - stage.top + bar.height / 2];
        const scale = picture.width / stage.width;
        const [red, green, blue] = context.getImageData(scale * x, scale * y, 1, 1).data;
        done({ name: this.download, width: picture.width, bar: Math.min(red, green, blue) < 200 });
    };
    picture.src = this.href;
};
document.getElementById('save').click();
"""


def settled(driver):
    """Waits until the picture stands still, and looks at it."""
    driver.execute_async_script(
        "const done = arguments[0]; setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)), 400)")
    return driver.execute_script(LOOK)


def use(driver, address, screenshot=None):
    wait = WebDriverWait(driver, 60)
    driver.get(address)
    wait.until(lambda d: d.execute_script("return window.stickslip !== undefined && stickslip.state.shown >= 0"))
    find = lambda name: driver.find_element("id", name)
    told = {"title": find("title").text, "bodies": find("body-count").text, "loaded": settled(driver)}
    frame = lambda: driver.execute_script("return stickslip.state.shown")

    find("first").click()
    wait.until(lambda _: frame() == 0)
    find("play").click()
    last = driver.execute_script("return stickslip.index().times.length - 1")
    wait.until(lambda _: frame() == last)
    told["played_to"] = frame()

    quantities = Select(find("quantity"))
    told["quantities"] = [option.get_attribute("value") for option in quantities.options]
    quantities.select_by_value("velocity")
    wait.until(lambda d: find("colorbar").is_displayed())
    told["colored"] = settled(driver)
    told["colorbar"] = find("colorbar").text
    driver.save_screenshot(screenshot) if screenshot else None

    # A click well inside the particles: beside them, half a pixel decides whether one is within reach.
    x, y = driver.execute_script("""
        const canvas = document.getElementById('canvas');
        const around = [[0, 0], [-9, 0], [9, 0], [0, -9], [0, 9]];
        for (let dy = 0.2; dy < 0.9; dy += 0.02) for (let dx = 0.2; dx < 0.9; dx += 0.02) {
            const [x, y] = [Math.round(dx * canvas.clientWidth), Math.round(dy * canvas.clientHeight)];
            if (around.every(([right, down]) => stickslip.pickAt(x + right, y + down))) return [x, y];
        }
        return [0, 0];
    """)
    driver.execute_script("document.querySelector('#picked .close').click()")
    canvas = find("canvas")
    size = canvas.size
    ActionChains(driver).move_to_element_with_offset(
        canvas, round(x - size["width"] / 2), round(y - size["height"] / 2)).click().perform()
    wait.until(lambda _: find("picked").is_displayed())
    told["picked"] = find("picked").text
    wait.until(lambda d: d.find_elements("css selector", "figure[data-chart=history]"))
    button = next(b for b in find("picked").find_elements("tag name", "button") if b.text == "Particle through time")
    button.click()
    # At once, for charts are made anew.
    captions = lambda: driver.execute_script(
        "return [...document.querySelectorAll('#charts figcaption')].map(caption => caption.textContent)")
    wait.until(lambda _: "particle" in captions()[-1])
    told["charts"] = captions()

    chart = driver.find_element("css selector", "figure[data-chart=energy] .u-over")
    ActionChains(driver).move_to_element(chart).perform()
    wait.until(lambda d: chart.text)
    told["readout"] = chart.text

    find("chains").click()
    find("arrows").click()
    wait.until(lambda _: "contacts" in find("force-scale").text)
    told["forces"] = find("force-scale").text
    if find("velocities").is_enabled():
        find("velocities").click()
        wait.until(lambda _: find("velocity-scale").text)
        told["velocities"] = find("velocity-scale").text
        find("velocities").click()
    if find("show-fringes").is_displayed():
        find("show-fringes").click()
        wait.until(lambda d: d.execute_script("return document.querySelector('#fringes img').naturalWidth > 0"))
        told["fringes"] = True

    find("none").click()
    told["without_bodies"] = settled(driver)
    find("all").click()
    told["with_bodies"] = settled(driver)
    draw = Select(find("draw"))
    if draw.options[1].is_enabled():
        draw.select_by_value("surfaces")
        wait.until(lambda d: d.execute_script("return stickslip.skins.isOn"))
        told["surfaces"] = settled(driver)
        draw.select_by_value("particles")
        wait.until(lambda d: not d.execute_script("return stickslip.skins.isOn"))
    cut = driver.find_element("css selector", "#cuts input[aria-label='x to']")
    driver.execute_script("arguments[0].value = 500; arguments[0].oninput()", cut)
    told["cut"] = settled(driver)
    told["cut_at"] = find("cuts").text
    told["sides"] = {}
    for side in find("sides").find_elements("tag name", "button"):
        if side.is_displayed():
            side.click()
            told["sides"][side.text] = settled(driver)["inked"]
    told["saved"] = driver.execute_async_script(SAVE)
    return told


def follow(driver, address):
    # The run takes a processor all the time.
    driver.set_script_timeout(120)
    wait = WebDriverWait(driver, 120)
    driver.get(address)
    wait.until(lambda d: d.execute_script("return window.stickslip !== undefined && stickslip.state.shown >= 0"))
    find = lambda name: driver.find_element("id", name)
    shown = lambda: driver.execute_script("return stickslip.state.shown")
    count = lambda: driver.execute_script("return stickslip.index().times.length")
    more = lambda than: wait.until(lambda _: count() > than)
    seen = [shown()]
    for _ in range(2):
        wait.until(lambda _: shown() > seen[-1])
        seen.append(shown())
    told = {"seen": seen, "looks": settled(driver)}
    # Between two looks it may say that it is running and no more.
    told["status"] = wait.until(lambda _: next(filter(lambda text: "running: " in text, [find("status").text]), None))
    wait.until(lambda d: d.find_elements("css selector", "figure[data-chart=energy]"))

    find("follow").click()
    more(count())
    told["stays"] = [shown()]
    more(count())
    told["stays"].append(shown())
    # From the last frame on, it goes on.
    find("follow").click()
    ActionChains(driver).send_keys(Keys.END).perform()
    last = count()
    wait.until(lambda _: shown() >= last)
    print("followed", flush=True)
    wait.until(lambda _: find("status").text == "interrupted")
    told["switch"] = find("follow-switch").is_displayed()
    wait.until(lambda _: shown() == count() - 1)
    told["frames"] = count()
    return told


def main(*words):
    act, words = (follow, words[1:]) if words[0] == "--follow" else (use, words)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        driver = browser(profile, FLAGS)
        try:
            driver.get("about:blank")
            for log in ["browser", "performance"]:
                driver.get_log(log)
            told = act(driver, *words)
            # What Chromium says of its graphics in software is no word of the page's.
            told["complaints"] = [
                entry["message"] for entry in driver.get_log("browser") if "GPU stall" not in entry["message"]
            ]
            told["requests"] = requests(driver, ("data:", "blob:", words[0]))
        finally:
            driver.quit()
    json.dump(told, sys.stdout)


main(*sys.argv[1:])
