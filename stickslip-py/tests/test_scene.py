"""Scenes in Python say what scene files say, and what is wrong with them is told in the same words."""

from __future__ import annotations

import copy
import json
import pickle
import re
import struct
import subprocess
import zlib

import numpy as np
import pytest
import stickslip as ss
from conftest import REPOSITORY, flying, rings, settling
from stickslip import _core
from stickslip.document import plain, written

FILES = sorted(path for path in (REPOSITORY / "scenes").rglob("*.toml") if "[[bodies]]" in path.read_text())


def record(scene: ss.Scene) -> dict:
    """The scene as run.json has it, without what a title is by default."""
    read = json.loads(scene._read().record())
    return {key: value for key, value in read.items() if key != "title"}


def test_two_dimensions_are_plane_strain():
    scene = ss.Scene(dimension="2d", cell="1 mm", gravity=(0, -9.81))
    scene.material("steel", density=7800, neo_hookean=dict(bulk_modulus="160 GPa", shear_modulus="80 GPa"))
    scene.body("ball", material="steel", shape=ss.disk((0, 0.02), 0.01), velocity=(0, -1))
    read = record(scene.time(end="1 ms"))
    scene.set(**{"space.dimension": "plane-strain"})
    assert read == record(scene) and read["dimension"] == "plane-strain"


def test_values_come_back_as_they_were_written():
    numbers = [0.1 + 0.2, 1e16, -1e-300, 5e-324, 1.7976931348623157e308, float("inf"), 3, -0.0, 2**62]
    texts = ['a "quoted" \\ word', "tab\tline\nfeed", "\x7f\x01", "ü µ 漢", "", "'''", '"""', "two\nlines", "a\r\nb"]
    document = {
        "title": texts[0],
        "about": "several\nlines\n",
        "space": {"numbers": numbers, "truth": [True, False], "empty": {}, "none": [], "a key": {"b.c": [[1], [{}]]}},
        "materials": {"x y": {"law": {"k": 1.5}}, "z": {"density": 1}},
        "bodies": [{"texts": texts}, {"shape": {"union": [{"ball": {"radius": 1.0}}, {"box": {"min": [0, 1]}}]}}],
        "outputs": {"probes": [{"name": "a"}, {"name": "b"}], "fringes": {"light": "white"}, "tables": 0.1},
    }
    back = _core.document(written(document))
    assert back == document
    assert list(back) == ["title", "about", *list(document)[2:]] and list(back["materials"]) == ["x y", "z"]
    assert str(back["space"]["numbers"]) == str(numbers), "signs of zeros and kinds of numbers, too"


def test_arrays_tuples_and_numbers_of_numpy_are_taken():
    given = {"a": np.array([[1.0, 2.0]]), "b": (np.float32(0.5), np.int64(3), np.bool_(True)), "c": None}
    assert plain(given) == {"a": [[1.0, 2.0]], "b": [0.5, 3, True]}
    with pytest.raises(TypeError, match=r"bodies\[0\].velocity\[1\]: found a object; allowed: numbers"):
        ss.Scene("3d", 1).body("a", velocity=(0, object()))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_scene_files_come_and_go(path, tmp_path):
    loaded = ss.Scene.load(path)
    assert loaded.text() == path.read_text()
    # Changed and changed back, it is written anew, without the comments, and says the same.
    rewritten = ss.Scene.load(path)
    rewritten._loaded = None
    assert rewritten.text() != loaded.text() and record(rewritten) == record(loaded)
    rewritten.save(tmp_path / "copy.toml")
    elsewhere = record(ss.Scene.load(tmp_path / "copy.toml"))
    # Repeated bodies have formulas in their names, and those of arrays numbers behind them.
    body = loaded.document["bodies"][0]
    repeated = "{" in body["name"] or "array" in body
    assert repeated or elsewhere["bodies"][0]["name"] == body["name"]
    if not any(key in path.read_text() for key in ("file =", "csv =")):
        assert elsewhere == record(loaded)


def test_keywords_replace_parameters_as_set_does():
    path = REPOSITORY / "scenes/paper/backspin.toml"
    scene = ss.Scene.load(path, cells_per_radius=4, contact="gap", **{"time.end": "500 ms", "bodies[0].spin[1]": 2.5})
    given = [("cells_per_radius", "4"), ("contact", "gap"), ("time.end", "500 ms"), ("bodies[0].spin[1]", "2.5")]
    expected = json.loads(_core.ReadScene((str(path), path.read_text()), given, {}).record())
    assert json.loads(scene._read().record()) == expected
    assert expected["discretization"]["cell"] == 0.25 and expected["time"]["end"] == 0.5
    # And where the file itself is out of the game.
    scene.outputs(tables="1 ms")
    changed = record(scene)
    assert changed["outputs"].pop("tables") == 1e-3 and expected["outputs"].pop("tables") == 5e-3
    assert {**expected, "title": None} == {**changed, "title": None}


def test_an_unknown_parameter_is_refused():
    path = REPOSITORY / "scenes/paper/backspin.toml"
    with pytest.raises(ss.SceneError, match="no parameter `cells_per_radios`.*did you mean `cells_per_radius`"):
        ss.Scene.load(path, cells_per_radios=4)
    with pytest.raises(
        ss.SceneError, match=r"no parameter `end`; allowed: a parameter of the scene \(there are none\)"
    ):
        flying().set(end=3)
    with pytest.raises(ss.SceneError, match=r"found the key `bodies\[7\].velocity`"):
        flying().set(**{"bodies[7].velocity": (0, 0)})


def test_a_mistake_has_its_line_and_its_advice(tmp_path):
    scene = flying().body("other", material="rubber", shape=ss.ball((2, 0), 1))
    scene.document["bodies"][1]["shape"] = {"ball": {"center": [2, 0], "radios": 1}}
    with pytest.raises(ss.SceneError) as caught:
        scene.simulation()
    error = caught.value
    line = scene.text().splitlines()[error.line - 1]
    assert line[error.column - 1 :].startswith("radios")
    assert (error.key, error.file) == ("bodies[1].shape.ball.radios", "<scene in Python>")
    assert error.found == "unknown key `radios`" and error.allowed == "center, radius"
    assert error.help == "did you mean `radius`?"
    said = str(error).splitlines()
    expected = "found unknown key `radios`; allowed: center, radius; did you mean `radius`?"
    assert said[0] == f"<scene in Python>:{error.line}:{error.column}: {error.key}: {expected}"
    number, shown = said[1].split(" | ", 1)
    assert (int(number), shown) == (error.line, line)
    assert said[2].split(" | ", 1)[1] == " " * (error.column - 1) + "^^^^^^"
    assert isinstance(error, ValueError) and str(pickle.loads(pickle.dumps(error))) == str(error)

    # Of a file: its own line, though something was set; the same words as the command's.
    file = tmp_path / "scene.toml"
    file.write_text("# a comment\n\n" + flying().text().replace("density = 1000", 'density = "1 kg"'))
    with pytest.raises(ss.SceneError, match="density: found") as caught:
        ss.Scene.load(file, **{"time.end": 0.1})
    assert caught.value.file == str(file)
    assert file.read_text().splitlines()[caught.value.line - 1] == 'density = "1 kg"'
    with pytest.raises(ss.SceneError, match="scenes.toml: No such file.*; did you mean `scene.toml`"):
        ss.Scene.load(tmp_path / "scenes.toml")
    file.write_text("a = = 1")
    with pytest.raises(ss.SceneError, match="scene.toml:1:5: found .*\n     1 | a = = 1\n"):
        ss.Scene.load(file)


def test_what_the_command_says_is_what_is_raised(command, tmp_path):
    text = flying().text().replace("cell =", "cells =")
    (tmp_path / "scene.toml").write_text(text)
    ran = subprocess.run([command, "check", "scene.toml"], cwd=tmp_path, capture_output=True, text=True)
    with pytest.raises(ss.SceneError) as caught:
        ss.Scene.load(tmp_path / "scene.toml")
    assert ran.stderr.splitlines()[0] in str(caught.value)


def test_check_is_the_report_of_the_command(command, tmp_path):
    scene = settling()
    report = scene.check()
    assert report.particles > 0 and report["memory"] > 0.0
    assert any("not resolved" in warning.text for warning in report.warnings)
    scene.save(tmp_path / "scene.toml")
    ran = subprocess.run([command, "check", "scene.toml"], cwd=tmp_path, capture_output=True, text=True)
    here = str(report).replace("<scene in Python>", "scene.toml")

    def told(text):
        return [line for line in text.rstrip().splitlines()[1:] if not line.startswith("memory")]

    # The command counts its own memory and that of the picture, which Python does not draw.
    assert told(ran.stdout) == told(here), "all but the title and the memory"
    assert len(ran.stdout.splitlines()) == len(here.rstrip().splitlines())
    with pytest.raises(ss.SceneError, match="overlap"):
        settling().body("too much", material="rubber", shape=ss.disk((0, 0.1), 0.1)).check()


def test_pairs_without_a_word_on_friction_are_warned_of(tmp_path):
    scene = settling()
    scene.outputs(particles="never")
    del scene.document["contact"]
    said = "the friction of `disk` and `floor` is 0, as no .*contact.* says what it is"
    for begin in (scene.simulation, lambda: scene.run(tmp_path / "results")):
        with pytest.warns(ss.StickslipWarning) as warned:
            begin()
        (about,) = [warning for warning in warned if "friction" in str(warning.message)]
        assert re.fullmatch(said, str(about.message)) and about.filename == __file__


def test_every_table_of_the_language_has_its_method(tmp_path):
    scene = ss.Scene("plane-strain", "1 cm", about="all", gravity=(0, "-9.81 m/s^2"), particles_per_side=2)
    scene.parameter(radius="5 cm").domain(("-20 cm", -0.2), (0.2, 0.2), x_min="symmetry")
    scene.material("rubber", density=1000, neo_hookean=dict(young_modulus=1e6, poisson_ratio=0.3))
    corner = ss.rotated(ss.polygon([(0.1, 0.1), (0.15, 0.1), (0.1, 0.15)]), (0.1, 0.1), "5 deg")
    scene.shape("hole", ss.disk((0, 0), "2 cm"))
    scene.body("disk", material="rubber", shape=ss.difference(ss.disk((0, 0), "radius"), "hole"))
    scene.body("corner", material="rubber", shape=ss.union(corner, ss.box((0.12, 0), (0.15, 0.03))))
    scene.body(
        "half", material="rubber", shape=ss.intersection(ss.disk((-0.1, 0.1), 0.03), ss.half_space((-0.1, 0.1), (0, 1)))
    )
    scene.contact(("disk", "corner"), friction=0.3).contact(friction="inf")
    scene.support("disk", on="x_min").load("disk", on="x_max", force=(0, 1))
    wheel = ss.disk((-0.1, -0.1), "2 cm")
    scene.body("wheel", material="rubber", shape=wheel, rigid=dict(free={})).joint("wheel", hinge=dict(point=(-0.1, -0.1)))
    scene.time(end="1 ms", courant=0.3).damping(viscous=1)
    scene.outputs(tables="0.1 ms", tractions=dict(interval="0.2 ms")).probe("p", at=(0.03, 0)).section("s", point=(0, 0), normal=(1, 0)).group("g", bodies=["w*"]).arrival("speed", "1 mm/s", probes=["p"])
    scene.front("f", quantity="speed", threshold="1 mm/s", from_=(0, 0), direction=(1, 0), bodies=["disk"])
    scene.reference("disk", "x", "0 m/s * t", "at rest")
    found = record(scene)
    assert found["bodies"][0]["shape"]["difference"][1] == {"ball": {"center": [0.0, 0.0, 0.0], "radius": 0.02}}
    assert [load["name"] for load in found["loads"]] == ["support 1", "load 1"]
    assert [len(found[key]) for key in ("bodies", "joints", "contact", "references")] == [4, 1, 2, 1]
    measured = found["outputs"]["measurements"]
    assert [len(measured[key]) for key in ("probes", "arrivals", "fronts", "sections", "groups")] == [1, 1, 1, 1, 1]
    assert measured["fronts"][0]["from"] == [0.0, 0.0, 0.0] and measured["tractions"]["interval"] == 2e-4
    assert found["time"]["courant"] == 0.3 and found["damping"]["viscous"] == 1.0
    assert found["domain"]["faces"][0] == ["symmetry", "open"]
    space = ss.Scene("3d", 0.1).material("rubber", **scene.document["materials"]["rubber"]).time(end=1)
    space.body("rod", material="rubber", shape=ss.cylinder((0, 0, 0), (1, 0, 0), 0.3))
    assert record(space)["bodies"][0]["name"] == "rod"


def test_every_shape_of_the_language_has_its_function():
    scene = ss.Scene("3d", 0.1).material("rubber", density=1, neo_hookean=dict(young_modulus=1, poisson_ratio=0.3))
    shapes = [
        ss.cone((0, 0, 0), (0, 0, 1), 0.5),
        ss.ring((0, 0, 0), 0.3, 0.5, (0, 0, 1), "20 cm"),
        ss.capsule((0, 0, 0), (1, 0, 0), 0.3),
        ss.rounded_box((0, 0, 0), (1, 1, 1), 0.1),
        ss.ellipsoid((0, 0, 0), (0.5, 0.4, 0.3)),
        ss.superquadric((0, 0, 0), (0.5, 0.4, 0.3), 4, 3),
        ss.torus((0, 0, 0), (0, 0, 1), 0.5, 0.2),
        ss.spline([(0, 0), (1, 0), (0, 1)], (0, 1)),
        ss.revolved((0, 0, 0), (0, 0, 1), polygon=[(0, 0), (1, 0), (0, 1)]),
        ss.revolved((0, 0, 0), (0, 0, 1), spline=[(0, 0), (1, 1), (0, 2)]),
    ]
    for i, shape in enumerate(shapes):
        scene.body(f"body {i}", material="rubber", shape=shape)
    kinds = [next(iter(body["shape"])) for body in record(scene.time(end=1))["bodies"]]
    solids = ["revolved", "revolved", "capsule", "rounded-box", "ellipsoid", "superquadric", "torus"]
    assert kinds == [*solids, "polygon", "revolved", "revolved"]
    plane = ss.Scene("plane-strain", 0.1).material("rubber", **scene.document["materials"]["rubber"]).time(end=1)
    plane.body("ring", material="rubber", shape=ss.ring((0, 0), 0.3, 0.5))
    plane.body("egg", material="rubber", shape=ss.ellipsoid((2, 0), (0.3, 0.5)))
    assert [next(iter(body["shape"])) for body in record(plane)["bodies"]] == ["difference", "ellipsoid"]


def test_an_image_makes_bodies_of_its_labels(tmp_path, monkeypatch):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    # Two squares of 6 x 6 pixels, labels 3 and 7: a grey image of 8 bits.
    rows = [b"\0" + bytes([3] * 6 + [0] * 4 + [7] * 6) for _ in range(6)]
    header = struct.pack(">IIBBBBB", 16, 6, 8, 0, 0, 0, 0)
    data = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(rows))) + chunk(b"IEND", b"")
    (tmp_path / "labels.png").write_bytes(b"\x89PNG\r\n\x1a\n" + data)
    rows = [f"{x + 20.5},{y + 0.5},1" for x in range(6) for y in range(6)]
    (tmp_path / "stones.csv").write_text("\n".join(["x,y,volume", *rows]))
    monkeypatch.chdir(tmp_path)
    scene = ss.Scene("plane-strain", "1 mm").time(end=1)
    scene.material("sand", density=1, neo_hookean=dict(young_modulus=1, poisson_ratio=0.3))
    scene.image("grain", "labels.png", pixel="1 mm", material="sand")
    scene.point_cloud("stone", "stones.csv", unit="1 mm", material="sand")
    assert [body["name"] for body in record(scene)["bodies"]] == ["grain 3", "grain 7", "stone"]


def test_meshes_are_found_from_where_a_scene_is_saved(tmp_path, monkeypatch):
    source = REPOSITORY / "scenes/shapes/hoop.toml"
    scene = ss.Scene.load(source)
    scene.outputs(tables=0.1)
    (tmp_path / "far").mkdir()
    scene.save(tmp_path / "far" / "hoop.toml")
    [here, there] = [found.check() for found in (scene, ss.Scene.load(tmp_path / "far" / "hoop.toml"))]
    assert there.particles == here.particles > 0
    # A scene that has no file looks from the current folder.
    free = ss.Scene("3d", 0.1).material("rubber", **next(iter(scene.document["materials"].values()))).time(end=1)
    free.body("hoop", material="rubber", shape=ss.mesh("hoop.obj"))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ss.SceneError, match="hoop.obj"):
        free.check()
    monkeypatch.chdir(source.parent)
    assert free.check().particles > 0


def test_scenes_are_copied_pickled_compared_and_shown():
    scene = ss.Scene.load(REPOSITORY / "scenes/paper/backspin.toml", cells_per_radius=4)
    for twin in (pickle.loads(pickle.dumps(scene)), copy.deepcopy(scene)):
        assert twin == scene and twin._read().record() == scene._read().record()
        twin.time(end=2)
        assert twin != scene and scene.document["time"]["end"] == "1 s"
    assert repr(rings()) == "<Scene 'rings': 2 bodies, plane-strain, cells of 4 mm>"
    assert "&quot;plane-strain&quot;" in rings()._repr_html_() and rings()._repr_html_().endswith("</pre>")
    assert "<pre>" in rings().check()._repr_html_()


def test_packings_repeats_and_patterns_are_words_like_others():
    scene = ss.Scene(dimension="plane-strain", cell="1 mm")
    scene.material("clay", density=1000, neo_hookean=dict(young_modulus="1 MPa", poisson_ratio=0.3))
    box = ss.box((0, 0), (0.05, 0.03))
    sizes = dict(uniform=(0.8, 1.2))
    scene.packing("grain", material="clay", shape=ss.disk((0, 0), 0.002), within=box, solid_fraction=0.7, sizes=sizes)
    scene.body("post {i}", repeat=dict(i=3), material="clay", shape=ss.disk(("i * 2 cm", "-1 cm"), "4 mm"))
    scene.contact(("grain *", "post *"), friction=0.3).time(end=1)
    read = record(scene)
    grains = [body for body in read["bodies"] if body["name"].startswith("grain ")]
    area = sum(np.pi * body["shape"]["ball"]["radius"] ** 2 for body in grains)
    assert area / (0.05 * 0.03) == pytest.approx(0.7, rel=1e-12)
    assert [body["name"] for body in read["bodies"][:3]] == ["post 0", "post 1", "post 2"]
    scene.document["packings"][0]["solid_fraction"] = 0.95
    with pytest.raises(ss.SceneError) as caught:
        scene.check()
    assert caught.value.key == "packings[0].solid_fraction" and "jam" in caught.value.found


def test_keys_that_there_are_none_of_are_found_at_once():
    scene = ss.Scene("plane-strain", 0.1)
    scene.body("first", material="rubber", shape=ss.disk((0, 0), 1))
    wrong = [
        (lambda: scene.body("ball", materiel="rubber"), "bodies[1].materiel", "material"),
        (
            lambda: scene.body("ball", material="rubber", shape={"ball": {"radios": 1}}),
            "bodies[1].shape.ball.radios",
            "radius",
        ),
        (lambda: scene.material("rubber", densty=1), "materials.rubber.densty", "density"),
        (
            lambda: scene.material("rubber", density=1, neo_hookean=dict(youngs_modulus=1, poisson_ratio=0.3)),
            "materials.rubber.neo_hookean.youngs_modulus",
            "young_modulus",
        ),
        (lambda: scene.contact(frictoin=0.3), "contact[0].frictoin", "friction"),
        (lambda: scene.load("first", presure=1), "loads[0].presure", "pressure"),
        (lambda: scene.support("first", velocty=1), "supports[0].velocty", "velocity"),
        (lambda: scene.time(ends=1), "time.ends", "end"),
        (lambda: scene.outputs(tabels=1), "outputs.tabels", "tables"),
        (lambda: scene.probe("here", (0, 0), boddy="first"), "outputs.probes[0].boddy", "body"),
        (lambda: scene.domain((0, 0), (1, 1), x_mn="fixed"), "space.domain.x_mn", "x_min"),
        (lambda: ss.Scene("plane-strain", 0.1, bases="gimp"), "space.bases", "basis"),
    ]
    before = scene.text()
    for give, key, meant in wrong:
        with pytest.raises(ss.SceneError) as error:
            give()
        assert error.value.key == key and f"did you mean `{meant}`?" in error.value.help, (key, error.value)
        assert f"{key}: found unknown key `{key.split('.')[-1]}`; allowed: " in str(error.value)
    assert scene.text() == before, "what is refused leaves nothing"
    # What the command says of the same key.
    scene.document["bodies"][0]["materiel"] = "rubber"
    scene.material("rubber", density=1, neo_hookean=dict(young_modulus=1, poisson_ratio=0.3)).time(end=1)
    with pytest.raises(ss.SceneError) as late:
        scene.check()
    with pytest.raises(ss.SceneError) as early:
        scene.body("first", materiel="rubber")
    assert (late.value.found, late.value.allowed, late.value.help) == (
        early.value.found,
        early.value.allowed,
        early.value.help,
    )


def test_what_is_not_there_yet_is_no_mistake_until_the_scene_is_read(tmp_path):
    scene = ss.Scene("plane-strain", "size / 10")
    scene.body("part", material="later", shape=ss.mesh(tmp_path / "none.stl"), velocity=("speed", 0))
    scene.contact(("part", "other"), friction="mu").load("other", force=(0, "load"))
    assert len(scene.document["bodies"]) == 1
    with pytest.raises(ss.SceneError):
        scene.check()
