"""Reads frames.xdmf as ParaView would, with nothing of the writer's code: every DataItem must resolve to an HDF5
dataset of the stated shape and type, every cell to points of its grid, and every frame of /times must be there.

    /usr/bin/python3 tests/files/check_xdmf.py RESULT_FOLDER      exit 0: sound, 1: the first fault is printed
"""

import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import h5py
import numpy as np

COMPONENTS = {"Scalar": 1, "Vector": 3}
POINTS_PER_CELL = {"Triangle": 3, "Polyline": 2}


def load(item: xml.Element, folder: Path) -> np.ndarray:
    """The array of a DataItem, with its shape and type checked."""
    assert item.get("Format") == "HDF" and item.text, f"not heavy data: {item.attrib}"
    file, path = item.text.strip().split(":")
    with h5py.File(folder / file, "r") as heavy:
        data = heavy[path][()]
    shape = tuple(int(n) for n in item.get("Dimensions", "").split())
    assert data.shape == shape, f"{path}: stored {data.shape}, stated {shape}"
    kind = {"Float": "f", "Int": "i"}[item.get("NumberType", "")]
    assert data.dtype.kind == kind and data.dtype.itemsize == int(item.get("Precision", "0")), f"{path}: {data.dtype}"
    return data


def child(parent: xml.Element, tag: str) -> xml.Element:
    element = parent.find(tag)
    assert element is not None, f"<{parent.tag} {parent.attrib}> has no <{tag}>"
    return element


def check_grid(grid: xml.Element, folder: Path) -> float:
    """Checks one frame of one grid; returns its time."""
    geometry, topology = child(grid, "Geometry"), child(grid, "Topology")
    assert geometry.get("GeometryType") == "XY"
    points = load(child(geometry, "DataItem"), folder)
    cells = load(child(topology, "DataItem"), folder)
    per_cell = POINTS_PER_CELL[topology.get("TopologyType", "")]
    assert cells.shape == (int(topology.get("NumberOfElements", "")), per_cell), f"cells: {cells.shape}"
    assert topology.get("TopologyType") != "Polyline" or topology.get("NodesPerElement") == "2"
    assert points.shape[1] == 2 and cells.min(initial=0) >= 0 and cells.max(initial=-1) < len(points)
    for attribute in grid.findall("Attribute"):
        values = load(child(attribute, "DataItem"), folder)
        components = COMPONENTS[attribute.get("AttributeType", "")]
        count = {"Node": len(points), "Cell": len(cells)}[attribute.get("Center", "")]
        assert values.shape == ((count,) if components == 1 else (count, components)), attribute.attrib
    return float(child(grid, "Time").get("Value", "nan"))


def check(folder: Path) -> None:
    root = xml.parse(folder / "frames.xdmf").getroot()
    with h5py.File(folder / "frames.h5", "r") as heavy:
        times = heavy["times"][()]
        names = {name for name, group in heavy.items() if name != "times" and "cells" in group}
    collections = child(root, "Domain").findall("Grid")
    assert {c.get("Name") for c in collections} == names, f"grids: {names}"
    for collection in collections:
        assert collection.get("GridType") == "Collection" and collection.get("CollectionType") == "Temporal"
        found = [check_grid(grid, folder) for grid in collection.findall("Grid")]
        assert np.array_equal(found, times), f"{collection.get('Name')}: times {found}, stored {times}"


if __name__ == "__main__":
    try:
        check(Path(sys.argv[1]))
    except (AssertionError, KeyError, OSError, ValueError, xml.ParseError) as fault:
        print(f"{sys.argv[1]}: {fault}")
        sys.exit(1)
