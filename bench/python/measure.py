"""How long a step takes from Python and by the command, in turns on the same scenes.

    cargo build --release --bin stickslip
    pip install .
    python bench/python/measure.py [--scene sphere] [--rounds 7] [--threads 1] [STICKSLIP]

P1 is `stickslip bench`'s cube of 262,144 particles, the sphere is the paper's with cells of R/4. A round takes each way
once: the command's run, the same run by `Scene.run`, and a loop of `Simulation.step`. Outputs are tables of the start
and the end alone, and no checkpoints. A line of the table has the shortest step of all rounds by the command, and over
it those of the other two ways; in brackets is the median of the ratios of each round, which slow changes of the machine
leave alone.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
import time
import warnings
from pathlib import Path

import stickslip as ss

ROOT = Path(__file__).resolve().parents[2]
QUIET = {"outputs.particles": "never", "outputs.tables": "1 s"}
SCENES = {
    "P1": ("scenes/bench/cube.toml", {"time.end": "10 ms", **QUIET}),
    "sphere": ("scenes/paper/backspin.toml", {"cells_per_radius": 4, **QUIET}),
}


def by_command(program, path, given, threads, out):
    """Wall time of a step of the command's run [s]."""
    line = [program, "run", path, "--out", out, "--threads", threads, "--checkpoint-every", "never", "--quiet"]
    line += [word for name, value in given.items() for word in ("--set", f"{name}={value}")]
    subprocess.run([str(word) for word in line], check=True, capture_output=True)
    performance = json.loads((out / "run.json").read_text())["performance"]
    return performance["wall_time"] / performance["steps"]


def by_run(scene, threads, out):
    """The same of `Scene.run`."""
    performance = scene.run(out, threads=threads, checkpoint_every=None).performance
    return performance.wall_time / performance.steps


def by_steps(scene, threads):
    """The same of a loop of `Simulation.step`."""
    sim = scene.simulation(threads)
    began = time.perf_counter()
    while sim.end - sim.time > 1e-6 * sim.end:
        sim.step(sim.end - sim.time)
    return (time.perf_counter() - began) / sim.steps


def measured(name, program, rounds, threads):
    path, given = SCENES[name]
    scene = ss.Scene.load(ROOT / path, **given)
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(rounds):
            command, run = (Path(folder) / f"{way}{number}" for way in ("command", "run"))
            found.append((by_command(program, ROOT / path, given, threads, command), by_run(scene, threads, run),
                          by_steps(scene, threads)))
    command, *others = zip(*found)
    ratios = [f"{min(other) / min(command):.3f} ({statistics.median(b / a for a, b in zip(command, other)):.3f})"
              for other in others]
    return f"| {name} | {scene.check().particles:,} | {1e3 * min(command):.2f} | {' | '.join(ratios)} |"


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("program", nargs="?", metavar="STICKSLIP", default=ROOT / "target/release/stickslip")
    words.add_argument("--scene", choices=SCENES, action="append", help="only this; may be repeated")
    words.add_argument("--rounds", type=int, default=7)
    words.add_argument("--threads", type=int, default=1)
    given = words.parse_args()
    warnings.simplefilter("ignore", ss.StickslipWarning)
    print("| scene | particles | step by the command [ms] | by Scene.run, over that | by Simulation.step, over that |")
    print("|---|---|---|---|---|")
    for name in given.scene or SCENES:
        print(measured(name, given.program, given.rounds, given.threads), flush=True)


main()
