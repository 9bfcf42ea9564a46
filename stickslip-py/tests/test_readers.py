"""Files of a run are opened by the readers that people use, and tables go to the packages that they compute with.

Set-up: the two rings in the plane, and a ball in space, each with snapshots of particles, surfaces and the grid.

Expected: every reader finds all particles and columns bit for bit; triangles of surfaces enclose the area or the volume
of the particles (those of the start: within 3 % in the plane and 6 % for the ball, whose surface lies within half a
particle); the mass of the nodes is that of the particles (round-off). Before the first step the grid has no nodes, and meshio
refuses files without points; it knows no polygons (`.vtp`), for which a run can write grids (`.vtu`). Packages that are not installed are skipped; `./check` installs meshio and VTK, `./check
--all` the others, too.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import stickslip as ss
from conftest import REPOSITORY, flying, rings

Found = tuple[np.ndarray, dict[str, np.ndarray], dict[str, np.ndarray]]
"""Points, cells by their kind, arrays of the points by their names."""
KINDS = {1: "vertex", 5: "triangle"}
"""VTK's numbers of the cells that there are."""


def by_meshio(path: Path) -> Found:
    mesh = pytest.importorskip("meshio").read(path)
    return mesh.points, {block.type: block.data for block in mesh.cells}, mesh.point_data


def by_vtk(path: Path) -> Found:
    io = pytest.importorskip("vtkmodules.vtkIOXML")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    complaints: list[str] = []
    polygons = path.suffix == ".vtp"
    reader = io.vtkXMLPolyDataReader() if polygons else io.vtkXMLUnstructuredGridReader()
    for event in ("ErrorEvent", "WarningEvent"):
        reader.AddObserver(event, lambda _, name: complaints.append(name))
    reader.SetFileName(str(path))
    reader.Update()
    assert complaints == []
    grid = reader.GetOutput()
    data, points = grid.GetPointData(), grid.GetPoints()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    kinds = {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}
    joined = vtk_to_numpy((grid.GetPolys() if polygons else grid.GetCells()).GetConnectivityArray())
    cells = {KINDS[kind]: joined.reshape(grid.GetNumberOfCells(), -1) for kind in kinds}
    return vtk_to_numpy(points.GetData()), cells, arrays


def by_pyvista(path: Path) -> Found:
    mesh = pytest.importorskip("pyvista").read(path)
    if path.suffix == ".vtp":
        cells = {"triangle": mesh.regular_faces}
    else:
        cells = {KINDS[kind]: cells for kind, cells in mesh.cells_dict.items()} if mesh.n_cells else {}
    return np.asarray(mesh.points), cells, {name: np.asarray(mesh.point_data[name]) for name in mesh.point_data}


READERS = [by_meshio, by_vtk, by_pyvista]


def run(space: str, folder: Path, **outputs) -> ss.Results:
    """Of a run with files of every kind."""
    scene = rings() if space == "plane" else flying("3d").time(end="10 ms")
    times = dict(particles="5 ms", surfaces="5 ms", grid="5 ms")
    scene.outputs(tables="1 ms", snapshots=dict(precision="double"), **times, **outputs).run(folder)
    return ss.Results(folder)


@pytest.fixture(scope="module", params=["plane", "space"])
def results(request, tmp_path_factory) -> ss.Results:
    """With surfaces as polygons."""
    return run(request.param, tmp_path_factory.mktemp(request.param) / "results")


@pytest.fixture(scope="module", params=["plane", "space"])
def with_grids(request, tmp_path_factory) -> ss.Results:
    """With surfaces as unstructured grids."""
    return run(request.param, tmp_path_factory.mktemp(request.param) / "grids", surface_format="vtu")


@pytest.fixture(scope="module", params=["plane", "space"])
def with_models(request, tmp_path_factory) -> ss.Results:
    """With surfaces as models."""
    return run(request.param, tmp_path_factory.mktemp(request.param) / "models", surface_format="glb")


def files(results: ss.Results, kind: str) -> list[Path]:
    """The files of a series, in the order of their times."""
    entries = list(xml.etree.ElementTree.parse(results.folder / f"{kind}.pvd").getroot().iter("DataSet"))
    times = [float(entry.attrib["timestep"]) for entry in entries]
    assert times[0] == 0.0 and times[-1] == 0.01 and times == sorted(times)
    return [results.folder / entry.attrib["file"] for entry in entries]


def enclosed(corners: np.ndarray, triangles: np.ndarray, plane: bool) -> float:
    """Area of triangles in the plane [m^2], volume within those in space, whose normals point outward [m^3]."""
    a, b, c = (corners[triangles[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    return float(np.linalg.norm(across, axis=1).sum() / 2 if plane else (a * across).sum() / 6)


@pytest.mark.parametrize("read", READERS)
def test_a_file_in_pieces_is_opened(tmp_path: Path, read: Callable[[Path], Found]):
    """Of more particles than a piece holds."""
    scene = ss.Scene("plane-strain", 0.1)
    scene.material("rubber", density=1000, neo_hookean=dict(young_modulus=1e6, poisson_ratio=0.3))
    scene.body("plate", material="rubber", shape=ss.box((0, 0), (15, 15)), velocity=(1, 0))
    scene.time(end="1 us").outputs(particles="1 us").run(tmp_path / "results")
    path = tmp_path / "results" / "particles" / "00001.vtu"
    assert path.read_bytes().count(b"<Piece ") == 2
    points, cells, arrays = read(path)
    frame = ss.Results(tmp_path / "results").frame(1)
    assert len(points) == 90000 and np.array_equal(arrays["number"].ravel(), np.arange(90000))
    assert np.array_equal(points, frame["position"])
    assert np.array_equal(arrays["stress"].reshape(-1, 6), frame["stress"])
    # Of cells meshio keeps those of the last piece.
    first = 65536 if read is by_meshio else 0
    assert np.array_equal(cells["vertex"].ravel(), np.arange(first, 90000))


@pytest.mark.parametrize("read", READERS)
def test_every_file_of_a_run_is_opened(with_grids, read: Callable[[Path], Found]):
    results = with_grids
    frames = [results.frame(number) for number in range(len(results.times))]
    particles, surfaces, grids = (files(results, kind) for kind in ("particles", "surfaces", "grid"))
    assert len(particles) == len(frames) == len(surfaces) == len(grids)
    for frame, *paths in zip(frames, particles, surfaces, grids):
        (points, cells, arrays), skin = map(read, paths[:2])
        count = len(frame["number"])
        assert np.array_equal(points, frame["position"]) and set(arrays) == set(frame) - {"position"}
        assert np.array_equal(cells["vertex"].ravel(), np.arange(count))
        for name, found in arrays.items():
            assert np.array_equal(found.reshape(frame[name].shape), frame[name]), name

        are_surfaces(skin, frame)

        if frame.time == 0.0 and read is by_meshio:
            continue
        nodes, _, at_nodes = read(paths[2])
        if frame.time == 0.0:
            assert len(nodes) == 0, "no step, no nodes"
            continue
        assert len(nodes) == len(at_nodes["mass"]) == len(at_nodes["contact_impulse"])
        assert at_nodes["mass"].sum() == pytest.approx(frame["mass"].sum(), rel=1e-9)


def are_surfaces(skin: Found, frame: ss.Frame) -> None:
    """Whether triangles are the surfaces of the bodies in a snapshot."""
    corners, triangles, at_corners = skin
    plane, own = not corners[:, 2].any(), frame["volume"].sum()
    assert enclosed(corners, triangles["triangle"], plane) == pytest.approx(own, rel=0.03 if plane else 0.06)
    assert set(at_corners) == {"velocity", "von_mises", "body"}
    assert set(at_corners["body"].ravel()) == set(frame["body"])


@pytest.mark.parametrize("read", [by_vtk, by_pyvista])
def test_polygons_are_opened(results, read: Callable[[Path], Found]):
    paths = files(results, "surfaces")
    assert [path.suffix for path in paths] == [".vtp"] * len(results.times)
    for number, path in enumerate(paths):
        are_surfaces(read(path), results.frame(number))


def test_models_of_a_run_are_opened(with_models):
    rows = np.genfromtxt(with_models.folder / "surfaces.csv", delimiter=",", names=True, dtype=None, encoding=None)
    assert np.array_equal(rows["time"], with_models.times) and not (with_models.folder / "surfaces.pvd").exists()
    for number, path in enumerate(rows["path"]):
        frame = with_models.frame(number)
        bodies = model(with_models.folder / path)
        assert len(bodies) == len(with_models.names)
        total = 0.0
        for corners, triangles, at_corners in bodies:
            plane = not corners[:, 2].any()
            total += enclosed(corners, triangles["triangle"], plane)
            assert len(at_corners["_VELOCITY"]) == len(at_corners["_VON_MISES"]) == len(corners)
        assert total == pytest.approx(frame["volume"].sum(), rel=0.03 if plane else 0.06)


def model(path: Path) -> list[Found]:
    """The surface of each body in a model."""
    pytest.importorskip("vtkmodules.vtkIOGeometry")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOGeometry import vtkGLTFReader

    reader = vtkGLTFReader()
    reader.SetFileName(str(path))
    reader.Update()
    found = []
    for mesh in meshes(reader.GetOutput()):
        data = mesh.GetPointData()
        arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
        triangles = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        found.append((vtk_to_numpy(mesh.GetPoints().GetData()), {"triangle": triangles}, arrays))
    return found


def test_a_model_is_opened_with_its_surfaces_and_colours(results, tmp_path):
    if not results.frame(0)["position"][:, 2].any():
        with pytest.raises(ss.ResultsError, match="^out: found a plane scene"):
            ss.render(results, out=tmp_path / "ball.glb")
        return
    ss.render(results, color="von_mises", out=tmp_path / "ball.glb")
    ((corners, triangles, names),) = model(tmp_path / "ball.glb")
    own = results.frame(-1)["volume"].sum()
    assert enclosed(corners, triangles["triangle"], plane=False) == pytest.approx(own, rel=0.06), "triangles face outward"
    assert any("COLOR_0" in name.upper() for name in names) and any("NORMAL" in name.upper() for name in names)
    # The frame is the last: the ball has flown and fallen; up, in the scene as in the model, is y.
    assert corners.mean(axis=0) == pytest.approx(results.frame(-1)["position"].mean(axis=0), abs=0.02)


def meshes(data) -> list:
    """The surfaces in what VTK read."""
    if data.IsA("vtkPolyData"):
        return [data]
    blocks = [data.GetBlock(i) for i in range(data.GetNumberOfBlocks())] if data.IsA("vtkMultiBlockDataSet") else []
    return [mesh for block in blocks if block is not None for mesh in meshes(block)]


def test_a_series_is_opened_by_pyvista(results):
    pyvista = pytest.importorskip("pyvista")
    for kind in ("particles", "surfaces", "grid"):
        reader = pyvista.get_reader(results.folder / f"{kind}.pvd")
        assert reader.time_values == [0.0, *reader.time_values[1:-1], 0.01]
        reader.set_active_time_value(0.01)
        assert reader.read()[0].n_points > 0


def test_snapshots_are_clouds_of_pyvista(results):
    pytest.importorskip("pyvista")
    frame = results.frame(-1)
    cloud = frame.to_pyvista()
    assert cloud.n_points == len(frame["number"]) and np.array_equal(cloud.points, frame["position"])
    assert np.array_equal(cloud.point_data["stress"], frame["stress"])
    assert set(cloud.point_data) == set(frame) - {"position"}


@pytest.mark.parametrize("package", ["pandas", "polars"])
def test_tables_are_frames_of_pandas_and_polars(results, package):
    pytest.importorskip(package)
    bodies, name = results.bodies, results.names[0]
    frame = getattr(bodies, f"to_{package}")()
    assert list(frame.columns) == list(bodies.dtype.names) and len(frame) == len(bodies)
    of_body = frame[frame["body"] == name] if package == "pandas" else frame.filter(frame["body"] == name)
    assert np.array_equal(of_body["vx"].to_numpy(), bodies.where(body=name)["vx"])


def test_tables_and_snapshots_are_datasets_of_xarray(results):
    pytest.importorskip("xarray")
    name = results.names[-1]
    rows, bodies = results.bodies.where(body=name), results.bodies.to_xarray()
    assert np.array_equal(bodies["vx"].sel(body=name), rows["vx"])
    assert np.array_equal(bodies["time"], rows["time"])
    frame = results.frame(-1)
    particles = frame.to_xarray()
    assert particles.attrs["time"] == 0.01 and particles["stress"].attrs == {"unit": "Pa"}
    assert np.array_equal(particles["stress"], frame["stress"])


def test_contacts_are_a_graph_of_networkx(tmp_path):
    networkx = pytest.importorskip("networkx")
    pytest.importorskip("pandas")
    chapter = (REPOSITORY / "book/15-python.md").read_text()
    (lines,) = re.findall(r"```text\n(graph = .*?)```", chapter, re.DOTALL)
    rows = [(0.5, "a", "b", 2.0), (0.5, "c", "b", 3.0)]
    kinds = [("time", float), ("body_a", "U1"), ("body_b", "U1"), ("normal", float)]
    now = ss.Table.of(np.array(rows, dtype=kinds))
    exec(lines.replace("contacts.graphml", str(tmp_path / "contacts.graphml")), dict(networkx=networkx, now=now))
    graph = networkx.read_graphml(tmp_path / "contacts.graphml")
    assert dict(graph.edges) == {
        ("a", "b"): dict(time=0.5, normal=2.0),
        ("c", "b"): dict(time=0.5, normal=3.0),
    }


def test_a_chart_is_drawn_by_matplotlib(results, tmp_path):
    pytest.importorskip("matplotlib").use("Agg")
    name = results.names[0]
    axes = results.plot(name, "vx")
    (line,) = axes.get_lines()
    rows = results.bodies.where(body=name)
    assert np.array_equal(line.get_xdata(), rows["time"]) and np.array_equal(line.get_ydata(), rows["vx"])
    axes.figure.savefig(tmp_path / "vx.png")
    assert (tmp_path / "vx.png").read_bytes()[:4] == b"\x89PNG"
