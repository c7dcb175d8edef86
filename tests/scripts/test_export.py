"""scripts/export.py: the files parse as XML, and decoded they are the arrays of frames.h5. All EXACT."""

import base64
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "UInt8": "u1"}

# As many points as cells, so that nothing but frames.xdmf tells which field is on which.
CELLS = {"bodies": np.array([[0, 1, 2], [2, 1, 3], [0, 2, 3], [0, 1, 3]], dtype="i4"),
         "outlines": np.array([[0, 1], [1, 2], [2, 3], [3, 0]], dtype="i4")}
FIELDS = {"bodies": {"velocity": "Node", "von_mises": "Cell"}, "outlines": {"contact_pressure": "Node"}}
TIMES = [0.0, 0.1 + 0.2, 0.7]


def write_frames(folder: Path) -> None:
    random = np.random.default_rng(1)
    text = '<?xml version="1.0" ?>\n<Xdmf Version="2.2">\n<Domain>\n'
    with h5py.File(folder / "frames.h5", "w") as file:
        file["times"] = TIMES
        for grid, cells in CELLS.items():
            file[f"{grid}/cells"] = cells
            file[f"{grid}/kind"] = np.array([0, 0, 1, 1], dtype="u1")
            file[f"{grid}/body"] = np.array([0, 0, 1, 1], dtype="i4")
            for index, time in enumerate(TIMES):
                frame = file.create_group(f"{grid}/{index:06}")
                frame.attrs["time"] = time
                frame["position"] = random.random((4, 2), dtype="f4")
                for name in FIELDS[grid]:
                    frame[name] = random.random((4, 3) if name == "velocity" else 4, dtype="f4")
            attributes = "".join(f'<Attribute Name="{name}" AttributeType="Scalar" Center="{centre}"/>'
                                 for name, centre in (FIELDS[grid] | {"kind": "Cell", "body": "Cell"}).items())
            frames = "".join(f'<Grid Name="{grid}"><Time Value="{time}"/>{attributes}</Grid>' for time in TIMES)
            text += f'<Grid Name="{grid}" GridType="Collection">{frames}</Grid>\n'
    (folder / "frames.xdmf").write_text(text + "</Domain>\n</Xdmf>\n")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_frames(tmp_path)
    return tmp_path


def export(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = ["/usr/bin/python3", "-B", str(ROOT / "scripts/export.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True)


def arrays(parent: ElementTree.Element, path: str) -> dict[str, np.ndarray]:
    """Decoded arrays below an element, by name."""
    result = {}
    for array in parent.iterfind(f"{path}/DataArray"):
        assert array.attrib["format"] == "binary"
        content = base64.b64decode(array.text, validate=True)
        assert np.frombuffer(content[:4], "<u4")[0] == len(content) - 4
        values = np.frombuffer(content[4:], TYPES[array.attrib["type"]])
        components = int(array.attrib.get("NumberOfComponents", 1))
        result[array.attrib["Name"]] = values.reshape(-1, components) if components > 1 else values
    return result


def check(file: Path, folder: Path, grid: str, index: int) -> None:
    root = ElementTree.parse(file).getroot()
    assert root.attrib == {"type": "UnstructuredGrid", "version": "1.0", "byte_order": "LittleEndian",
                           "header_type": "UInt32"}
    time = root.find("UnstructuredGrid/FieldData/DataArray")
    assert time.attrib["Name"] == "TimeValue" and float(time.text) == TIMES[index]
    piece = root.find("UnstructuredGrid/Piece")
    assert (piece.attrib["NumberOfPoints"], piece.attrib["NumberOfCells"]) == ("4", "4")
    with h5py.File(folder / "frames.h5") as stored:
        frame = stored[f"{grid}/{index:06}"]
        points = arrays(piece, "Points")["Points"]
        assert (points[:, :2] == frame["position"][()]).all() and (points[:, 2] == 0).all()
        for centre, path in (("Node", "PointData"), ("Cell", "CellData")):
            found = arrays(piece, path)
            assert set(found) == {n for n, c in (FIELDS[grid] | {"kind": "Cell", "body": "Cell"}).items() if c == centre}
            for name, values in found.items():
                assert (values == (stored[grid] if name in ("kind", "body") else frame)[name][()]).all(), name
        cells = arrays(piece, "Cells")
        size = CELLS[grid].shape[1]
        assert (cells["connectivity"].reshape(-1, size) == CELLS[grid]).all()
        assert list(cells["offsets"]) == [size * (i + 1) for i in range(4)]
        assert set(cells["types"]) == {5 if size == 3 else 3}


@pytest.mark.parametrize("options, index", [([], 2), (["--frame", 0], 0), (["--time", 0.4], 1), (["--time", 1], 2)])
def test_the_chosen_frame_is_written(folder: Path, options: list[object], index: int) -> None:
    result = export(folder, *options)
    assert result.returncode == 0, result.stderr
    names = [f"frame_{index:06}.vtu", f"frame_{index:06}_outlines.vtu"]
    assert result.stdout.split() == [str(folder / name) for name in names]
    for name, grid in zip(names, ("bodies", "outlines")):
        check(folder / name, folder, grid, index)


def test_out_names_both_files(folder: Path, tmp_path: Path) -> None:
    assert export(folder, "--out", tmp_path / "a.vtu").returncode == 0
    check(tmp_path / "a.vtu", folder, "bodies", 2)
    check(tmp_path / "a_outlines.vtu", folder, "outlines", 2)


@pytest.mark.parametrize("options", [["--frame", 3], ["--frame", -1], ["--frame", 0, "--time", 0], ["--time", "nan"],
                                     ["--time", 99], ["--out", "scene.toml"]])
def test_bad_frame_is_bad_input(folder: Path, options: list[object]) -> None:
    before = set(folder.iterdir())
    result = export(folder, *options)
    assert result.returncode == 2 and result.stderr.startswith(("error: ", "usage: "))
    assert set(folder.iterdir()) == before


@pytest.mark.parametrize("missing", ["frames.h5", "frames.xdmf"])
def test_missing_file_is_bad_input(folder: Path, missing: str) -> None:
    (folder / missing).unlink()
    result = export(folder)
    assert result.returncode == 2 and result.stderr.startswith(f"error: {folder / missing}: "), result.stderr


def test_unwritable_target_is_an_output_error(folder: Path) -> None:
    result = export(folder, "--out", folder / "nowhere/a.vtu")
    assert result.returncode == 4 and "Traceback" not in result.stderr
