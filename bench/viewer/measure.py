"""How fast the viewer is in a browser that draws in software, with 10^4, 10^5 and 10^6 particles in space.

    cargo build --release --bin stickslip
    python bench/viewer/measure.py [STICKSLIP]

Needs Chromium with its driver and the Python package `selenium`, which ./check puts into target/venv. A cube of rubber
flies and turns, with five snapshots; colour stands for its speed. Each line of the table says how many particles there
are and how many are drawn at rest (those that can be seen), how long such a picture takes, how many pictures a second
there are while the eye moves around (with fewer particles, if all would take too long), how many frames a second a
player gets whose rate is 25 a second, the first time and with all frames at hand, and how many bytes a frame moves.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "stickslip-cli/tests"))

from browser import browser  # noqa: E402
from selenium.webdriver.support.ui import Select, WebDriverWait  # noqa: E402

# Cells along a side, with eight particles in each cell.
SIDES = [11, 23, 50]
FLAGS = ["use-angle=swiftshader", "enable-unsafe-swiftshader", "window-size=1280,860"]
FRAMES = 5

PLAY = """
const done = arguments[0];
const start = performance.now();
const { pictures } = stickslip.state;
stickslip.play().then(() => done({
    rate: (stickslip.state.pictures - pictures) / ((performance.now() - start) / 1000),
    bytes: stickslip.state.places.byteLength + stickslip.state.column.byteLength,
}));
"""


def measured(driver, address):
    wait = WebDriverWait(driver, 120)
    driver.get(address)
    wait.until(lambda d: d.execute_script("return window.stickslip !== undefined && stickslip.state.shown >= 0"))
    Select(driver.find_element("id", "quantity")).select_by_value("velocity")
    Select(driver.find_element("id", "rate")).select_by_value("25")
    wait.until(lambda d: d.find_element("id", "colorbar").is_displayed())
    driver.set_script_timeout(300)
    driver.execute_script("stickslip.frames.forget()")
    play = driver.execute_async_script(PLAY)
    # Once more, with all frames at hand.
    driver.execute_async_script("stickslip.show(0).then(arguments[0])")
    again = driver.execute_async_script(PLAY)
    moved = driver.execute_async_script("stickslip.measure(4).then(arguments[0])")
    return play, again, moved


def main(stickslip=str(root / "target/release/stickslip")):
    print("| particles | drawn at rest | picture [ms] | pictures a second, moving | frames a second, first | again | MB a frame |")
    print("|---|---|---|---|---|---|---|")
    for side in SIDES:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            scene = root / "scenes/bench/cube.toml"
            run = [stickslip, "run", str(scene), "--out", f"{folder}/results", "--set", f"cells={side}", "--set",
                   "time.end=4 ms", "--set", "outputs.particles=1 ms", "--checkpoint-every", "never"]
            subprocess.run(run, check=True, capture_output=True)
            view = [stickslip, "view", f"{folder}/results", "--no-open"]
            server = subprocess.Popen(view, stdout=subprocess.PIPE, text=True)
            driver = browser(f"{folder}/profile", FLAGS)
            try:
                play, again, moved = measured(driver, server.stdout.readline().split()[0])
            finally:
                driver.quit()
                server.terminate()
                server.wait()
            print(f"| {moved['particles']:,} | {moved['drawn']:,} | {moved['full']:.0f} | {moved['moving']:.1f} "
                  f"| {play['rate']:.1f} | {again['rate']:.1f} | {play['bytes'] / 1e6:.2f} |", flush=True)


main(*sys.argv[1:])
