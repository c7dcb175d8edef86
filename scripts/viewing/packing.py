"""Frames as chunks of text: whole numbers by byte planes, deflated, in base64; a chunk for each frame and field, so
that a reader inflates what is shown. unpack.js reads them."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pliant.frames import COMPLIANT, BadFolder, Frames
from viewing.fields import LOOKS, Look, Scale, Spread
from viewing.shapes import Points, Shapes

_LEVEL = 6


def packed(numbers: np.ndarray, missing: np.ndarray | None = None) -> bytes:
    """Number of planes, then the lowest byte of every code, then the next. Codes are 0 for what is missing and 1, 2, 3,
    4 for 0, -1, 1, -2, and so on."""
    numbers = numbers.ravel().astype(np.int64)
    codes = np.where(numbers < 0, -2 * numbers, 2 * numbers + 1)
    if missing is not None:
        codes[missing.ravel()] = 0
    count = max(1, -(-int(codes.max(initial=0)).bit_length() // 8))
    planes = [((codes >> (8 * plane)) & 255).astype(np.uint8).tobytes() for plane in range(count)]
    return bytes([count]) + b"".join(planes)


def as_text(raw: bytes) -> str:
    return base64.b64encode(zlib.compress(raw, _LEVEL)).decode()


@dataclass
class Field:
    """A field that frames hold, and its scale over all that are shown."""

    name: str
    look: Look
    once: bool
    scale: Scale | None = None


def fields_of(frames: Frames, index: int) -> dict[str, Field]:
    """By name, in the order of the table of fields."""
    stored = {grid: frames.stored(grid, index) for grid in frames.grids}
    held = {grid: stored[grid] | frames.constants[grid] for grid in frames.grids}
    return {name: Field(name, look, name not in stored[look.grid]) for name, look in LOOKS.items()
            if name in held.get(look.grid, set())}


class Packing:
    """Frames of a run, ready to be written: `survey` goes over all of them, and so does `chunks`, one at a time."""

    def __init__(self, frames: Frames, chosen: list[int], fields: list[Field]) -> None:
        self.frames, self.chosen, self.fields = frames, chosen, fields
        self.points = Points(frames, chosen)
        self.shapes = Shapes(self.points, chosen[0])
        self.cell_order = np.argsort(self.points.cells.body, kind="stable")
        self.box = self._survey()

    def _survey(self) -> np.ndarray:
        """Extent of all points over all frames: [[least x, y], [largest x, y]]; scales on the way."""
        spreads = {field.name: Spread(field.look.centre) for field in self.fields}
        low, high = np.full(2, np.inf), np.full(2, -np.inf)
        for index in self.chosen:
            place = self.points.positions(index)
            self.shapes.judge(place)
            low, high = np.minimum(low, place.min(axis=0)), np.maximum(high, place.max(axis=0))
            for field in self.fields:
                values = self.values(field, index)
                spreads[field.name].add(np.linalg.norm(values, axis=0) if len(values) > 1 else values[0])
        for field in self.fields:
            field.scale = spreads[field.name].scale(field.look)
        return np.array([low, high])

    def values(self, field: Field, index: int) -> np.ndarray:
        """[components x points or cells], cells body by body; NaN where a field tells nothing."""
        look = field.look
        stored = self.frames.field(look.grid, index, field.name)
        if stored is None:
            raise BadFolder(f"{self.frames.path}: frame {index} of '{look.grid}' has no {field.name}")
        if look.at == "points":
            return stored[: len(self.points.cells.point_body), :2].T.astype(float)
        if look.at == "outlines":
            assert self.points.outlines is not None
            return stored[: len(self.points.outlines.point_body)].astype(float)[None]
        values = np.where(self.points.cells.kind == COMPLIANT, stored, np.nan) if look.of_compliant else stored
        return values[self.cell_order].astype(float)[None]

    def chunks(self) -> Iterator[tuple[str, str]]:
        """Names and texts."""
        for name, raw in self._topology():
            yield name, as_text(raw)
        soft = self.shapes.soft
        for number, index in enumerate(self.chosen):
            place = self.points.positions(index)
            motion = self.shapes.motion(place)
            apart = self.shapes.apart(place, motion)[soft]
            yield f"motion-{number}", as_text(motion.astype("<f4").tobytes())
            yield f"apart-{number}", as_text(packed(np.rint(apart / self.shapes.step).T))
            for field in self.fields:
                if not field.once or number == 0:
                    name = field.name if field.once else f"{field.name}-{number}"
                    yield name, as_text(self._coded(field, index))

    def _coded(self, field: Field, index: int) -> bytes:
        assert field.scale is not None
        return packed(*field.scale.codes(self.values(field, index)))

    def _topology(self) -> Iterator[tuple[str, bytes]]:
        """Cells and segments body by body, each told by its distance from the one before."""
        points = self.points
        yield "kind", packed(points.kind)
        yield "body", packed(np.diff(points.body, prepend=0))
        yield "soft", packed(np.diff(self.shapes.soft, prepend=0))
        yield "shape", packed(self.shapes.codes.T)
        yield "cell-body", packed(np.diff(points.cells.body[self.cell_order], prepend=0))
        yield "cells", packed(np.diff(points.cells.cells[self.cell_order].ravel(), prepend=0))
        if points.outlines is not None:
            order = np.argsort(points.outlines.body, kind="stable")
            yield "outline-points", packed(np.diff(points.of_outline, prepend=0))
            yield "segment-body", packed(np.diff(points.outlines.body[order], prepend=0))
            yield "segments", packed(np.diff(points.outlines.cells[order].ravel(), prepend=0))
