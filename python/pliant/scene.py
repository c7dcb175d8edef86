"""Scene files: read, changed and written, with their comments."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, MutableMapping, MutableSequence
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from pliant import engine
from pliant.engine import BadScene, Estimate
from pliant.names import nearest
from pliant.results import Run


class Scene:
    """A scene by dotted paths: scene["materials.soft.young"] = "2 GPa". Members of a list go by their number or their
    name: "grains.0.seed" or "grains.third_body.seed". What keys and values mean the engine knows: check()."""

    def __init__(self, text: str, file_name: str = "scene.toml", folder: Path | None = None) -> None:
        """`folder`: where the files are that the scene names; None: it names none."""
        self.file_name, self.folder = file_name, folder
        try:
            self._document = tomlkit.parse(text)
        except TOMLKitError as error:
            raise BadScene(f"{file_name}: {error}") from error

    @classmethod
    def read(cls, file: str | Path) -> Scene:
        """BadScene: it is not TOML; OSError: it cannot be read."""
        return cls(Path(file).read_text("utf-8-sig"), Path(file).name, Path(file).parent)

    def __getitem__(self, path: str) -> Any:
        """KeyError names what there is."""
        at: Any = self._document
        for name in path.split("."):
            at = _member(at, name, path)
        return at.unwrap() if hasattr(at, "unwrap") else at

    def __setitem__(self, path: str, value: Any) -> None:
        """A key that its table lacks is added, and the table if it is one of the whole scene, as [discretisation]; what
        is deeper, as a shape, must be there."""
        *parents, last = path.split(".")
        at: Any = self._document
        if len(parents) == 1 and parents[0] not in at:
            at[parents[0]] = tomlkit.table()
        for name in parents:
            at = _member(at, name, path)
        if isinstance(at, MutableSequence):
            at[_index(at, last, path)] = value
        elif isinstance(at, MutableMapping):
            if isinstance(at.get(last), MutableMapping) and not isinstance(value, MutableMapping):
                raise KeyError(f"{path}: it is a table, which {value!r} is not")
            at[last] = value
        else:
            raise KeyError(f"{path}: {'.'.join(parents)} is a value, not a table")

    def canonical(self, path: str) -> str:
        """With the numbers of all members of lists: two paths to one key are equal so. KeyError: no such member."""
        at: Any = self._document
        names = []
        for name in path.split("."):
            if isinstance(at, MutableSequence):
                name = str(_index(at, name, path))
                at = at[int(name)]
            else:
                at = at.get(name) if isinstance(at, MutableMapping) else None
            names.append(name)
        return ".".join(names)

    def __contains__(self, path: str) -> bool:
        try:
            self[path]
        except KeyError:
            return False
        return True

    def copy(self) -> Scene:
        return Scene(self.text(), self.file_name, self.folder)

    def files(self) -> list[str]:
        """Outlines, meshes and the like: texts that name files which are there, seen from the scene's folder; not the
        state that it starts from. BadScene: one is not at or below it, so it could not go along with a copy of the
        scene."""
        found: list[str] = []

        def look(at: Any, path: str = "") -> None:
            if isinstance(at, MutableMapping):
                for key, value in at.items():
                    look(value, f"{path}.{key}")
            elif isinstance(at, MutableSequence):
                for value in at:
                    look(value, path)
            elif isinstance(at, str) and self.folder and path != ".start.from" and _may_name_a_file(
                    at, path.endswith(".file")) and (self.folder / at).is_file():
                if ".." in Path(at).parts:
                    raise BadScene(f"{self.file_name}: names {at}; only files at or below the scene's folder go along")
                found.append(str(at))

        look(self._document)
        return sorted(set(found))

    def state(self) -> Path | None:
        """The file with the state that it starts from, by an absolute path; None: it starts from none. Whether it is
        there the engine asks."""
        name = self["start.from"] if "start.from" in self else ""
        if not isinstance(name, str) or not name or self.folder is None:
            return None
        named = (self.folder / name).absolute()
        return named / "final.bin" if named.is_dir() else named

    def starting_from(self, state: str | Path) -> Scene:
        """A copy of one that starts from a state, which it is to find there."""
        changed = self.copy()
        changed["start.from"] = str(state)
        return changed

    def write_whole(self, folder: Path) -> Path:
        """Under its own name, with the files that it names; the state that it starts from stays where it is."""
        for name in self.files():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self.folder / name, folder / name)
        state = self.state()
        return (self if state is None else self.starting_from(state)).write(folder / self.file_name)

    def text(self) -> str:
        return tomlkit.dumps(self._document)

    def write(self, file: str | Path) -> Path:
        file = Path(file)
        file.write_text(self.text())
        return file

    def check(self, threads: int = 1) -> Estimate:
        """What it costs. BadScene with the engine's words."""
        with tempfile.TemporaryDirectory() as folder:
            return engine.check(self.write_whole(Path(folder)), threads)

    def run(self, folder: str | Path, threads: int = 1) -> Run:
        """Into a folder, over what is there; opens it. BadScene, RunFailed."""
        with tempfile.TemporaryDirectory() as scratch:
            return engine.run(self.write_whole(Path(scratch)), Path(folder), threads)


def _may_name_a_file(text: str, surely: bool) -> bool:
    return 0 < len(text) < 255 and text.isprintable() and (surely or "." in text) and not Path(text).is_absolute()


def _names(at: Any) -> Iterator[str]:
    if isinstance(at, MutableMapping):
        yield from at
    elif isinstance(at, MutableSequence):
        for number, member in enumerate(at):
            yield str(member["name"]) if isinstance(member, MutableMapping) and "name" in member else str(number)


def _index(at: MutableSequence, name: str, path: str) -> int:
    if name.isdigit() and int(name) < len(at):
        return int(name)
    for number, member in enumerate(at):
        if isinstance(member, MutableMapping) and member.get("name") == name:
            return number
    raise KeyError(f"{path}: no member '{name}'{nearest(name, _names(at))}")


def _member(at: Any, name: str, path: str) -> Any:
    if isinstance(at, MutableSequence):
        return at[_index(at, name, path)]
    if not isinstance(at, MutableMapping):
        raise KeyError(f"{path}: what '{name}' should be part of is a value, not a table")
    if name not in at:
        raise KeyError(f"{path}: no '{name}'{nearest(name, _names(at))}")
    return at[name]
