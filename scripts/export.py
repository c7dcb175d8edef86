#!/usr/bin/python3
"""Writes one frame of a run as VTK XML unstructured grids (.vtu), which ParaView, VisIt and PyVista read.

    ./pliant export results/third_body_mini --time 4e-6
    ./pliant export results/third_body_mini --frame 0 --out start.vtu

The grid of the bodies (triangles) goes to FILE.vtu, that of the outlines (segments) to FILE_outlines.vtu; every stored
field goes with its grid. Exit code 2: no such folder or frame, 4: a file cannot be written.
"""

import argparse
import base64
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from pliant.frames import BadFolder, Frames

BAD_INPUT, OUTPUT_FAILED = 2, 4
VTK_LINE, VTK_TRIANGLE = 3, 5
VTK_TYPES = {"float32": "Float32", "float64": "Float64", "int32": "Int32", "uint8": "UInt8"}


@dataclass
class Grid:
    """One grid at one time."""

    time: float  # s
    points: np.ndarray  # [points x 3], m
    cells: np.ndarray  # [cells x 2 or 3]
    point_data: dict[str, np.ndarray] = field(default_factory=dict)
    cell_data: dict[str, np.ndarray] = field(default_factory=dict)


def field_centres(file: Path) -> dict[str, dict[str, str]]:
    """For each grid the fields' centres, "Node" or "Cell", as the first frame in frames.xdmf has them: lengths alone do
    not tell where a grid has as many cells as points."""
    centres: dict[str, dict[str, str]] = {}
    try:
        collections = list(ElementTree.parse(file).iter("Grid"))
    except (OSError, ElementTree.ParseError) as error:
        raise BadFolder(f"{file}: cannot be read: {error}; give the folder that `pliant run` wrote") from error
    for collection in collections:
        first = collection.find("Grid")
        if first is not None:
            centres[collection.attrib["Name"]] = {a.attrib["Name"]: a.attrib["Center"] for a in first.iter("Attribute")}
    return centres


def frame_index(frames: Frames, time: float | None, frame: int | None) -> int:
    """The frame asked for, the one nearest to a time, or the last."""
    count = len(frames.times)
    if count == 0:
        raise BadFolder(f"{frames.path}: the run has no frame yet")
    if time is not None:
        return frames.nearest(time)
    index = count - 1 if frame is None else frame
    if not 0 <= index < count:
        raise BadFolder(f"{frames.path}: no frame {index}; there are 0 to {count - 1}")
    return index


def read_grid(frames: Frames, name: str, index: int, centres: dict[str, str]) -> Grid:
    plane = frames.field(name, index, "position")
    if plane is None:
        raise BadFolder(f"{frames.path}: frame {index} of '{name}' has no positions")
    points = np.column_stack([plane, np.zeros(len(plane), plane.dtype)])
    grid = Grid(float(frames.times[index]), points, frames.grids[name].cells)
    for field_name, centre in centres.items():
        values = frames.field(name, index, field_name)
        if values is None:
            raise BadFolder(f"{frames.path}: frame {index} of '{name}' lacks {field_name}, which frames.xdmf names")
        (grid.point_data if centre == "Node" else grid.cell_data)[field_name] = values
    return grid


def read_frame(folder: Path, time: float | None, frame: int | None) -> tuple[int, dict[str, Grid]]:
    """Number of the frame, and its grids by name; walls as they are stored, not closed across the period."""
    frames = Frames(folder / "frames.h5", period=None)
    index = frame_index(frames, time, frame)
    centres = field_centres(folder / "frames.xdmf")
    return index, {name: read_grid(frames, name, index, centres[name]) for name in frames.grids}


def data_array(name: str, values: np.ndarray) -> str:
    """One array inline: its length in bytes as UInt32 and its values, together in base64."""
    values = np.ascontiguousarray(values.astype(values.dtype.newbyteorder("<")))
    components = f' NumberOfComponents="{values.shape[1]}"' if values.ndim > 1 else ""
    content = base64.b64encode(np.uint32(values.nbytes).tobytes() + values.tobytes()).decode()
    kind = VTK_TYPES[values.dtype.name]
    return f'<DataArray type="{kind}" Name="{name}"{components} format="binary">{content}</DataArray>\n'


def vtu(grid: Grid) -> str:
    count, size = grid.cells.shape
    kind = np.full(count, VTK_TRIANGLE if size == 3 else VTK_LINE, dtype=np.uint8)
    offsets = size * np.arange(1, count + 1, dtype=np.int32)
    point_data = "".join(data_array(name, values) for name, values in grid.point_data.items())
    cell_data = "".join(data_array(name, values) for name, values in grid.cell_data.items())
    time = f'<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{grid.time!r}</DataArray>'
    return (
        '<?xml version="1.0"?>\n'
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt32">\n'
        f"<UnstructuredGrid>\n<FieldData>{time}</FieldData>\n"
        f'<Piece NumberOfPoints="{len(grid.points)}" NumberOfCells="{count}">\n'
        f"<PointData>\n{point_data}</PointData>\n<CellData>\n{cell_data}</CellData>\n"
        f"<Points>\n{data_array('Points', grid.points)}</Points>\n"
        f"<Cells>\n{data_array('connectivity', grid.cells.ravel().astype(np.int32))}"
        f"{data_array('offsets', offsets)}{data_array('types', kind)}</Cells>\n"
        "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    )


def write(file: Path, text: str) -> None:
    """The file is whole or absent: written under another name first."""
    temporary = file.with_name(file.name + ".tmp")
    try:
        temporary.write_text(text)
        temporary.replace(file)
    finally:
        temporary.unlink(missing_ok=True)
    print(file)


def export(folder: Path, time: float | None, frame: int | None, out: Path | None) -> None:
    index, grids = read_frame(folder, time, frame)
    target = out or folder / f"frame_{index:06}.vtu"
    for name, grid in grids.items():
        write(target if name == "bodies" else target.with_name(f"{target.stem}_{name}{target.suffix}"), vtu(grid))


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="pliant export", description="Writes one frame of a run as .vtu files.",
                                     epilog="example: ./pliant export results/third_body_mini --time 4e-6")
    parser.add_argument("folder", type=Path, help="result folder of `pliant run`")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--time", type=float, metavar="SECONDS", help="the frame nearest to it (default: the last)")
    which.add_argument("--frame", type=int, metavar="N", help="number of the frame, from 0")
    parser.add_argument("--out", type=Path, metavar="FILE.vtu",
                        help="default: frame_N.vtu in the result folder; the outlines go to FILE_outlines.vtu")
    options = parser.parse_args(arguments)
    if options.out is not None and options.out.suffix != ".vtu":
        parser.error(f"argument --out: '{options.out}' must end with .vtu")
    return options


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    try:
        export(options.folder, options.time, options.frame, options.out)
    except BadFolder as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        print(f"error: {options.out or options.folder}: cannot be written: {error.strerror or error}", file=sys.stderr)
        return OUTPUT_FAILED
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
