"""Tables of a study file, read as strictly as scenes are: each key once, and none that nobody asks for."""

from __future__ import annotations

from typing import Any, NoReturn

from pliant.names import nearest


class BadStudy(Exception):
    """The study file is wrong; the message says what, where and what is allowed."""


class Reader:
    """Takes keys out of one table; done() refuses those that are left."""

    def __init__(self, table: dict[str, Any], place: str) -> None:
        self._table = dict(table)
        self._asked: list[str] = []
        self.place = place

    def fail(self, what: str) -> NoReturn:
        raise BadStudy(f"{self.place}: {what}")

    def has(self, key: str) -> bool:
        return key in self._table

    def take(self, key: str, kinds: type | tuple[type, ...], default: Any = ...) -> Any:
        """A value of one of the kinds; without a default it is required."""
        self._asked.append(key)
        if key not in self._table:
            if default is ...:
                self.fail(f"'{key}' is missing")
            return default
        value = self._table.pop(key)
        if not isinstance(value, kinds) or (isinstance(value, bool) and kinds is not bool):
            names = [kind.__name__ for kind in (kinds if isinstance(kinds, tuple) else (kinds,))]
            self.fail(f"'{key}' is {value!r}; it must be of type {' or '.join(names)}")
        return value

    def choice(self, key: str, allowed: list[str], default: Any = ...) -> str:
        value = self.take(key, str, default)
        if value is not None and value not in allowed:
            self.fail(f"'{key}' is '{value}'{nearest(value, allowed)}")
        return value

    def names(self, key: str, default: Any = ...) -> list[str]:
        value = self.take(key, list, default)
        if not all(isinstance(name, str) for name in value):
            self.fail(f"'{key}' is {value!r}; it must be a list of names")
        return value

    def whole(self, key: str, least: int, default: Any = ...) -> int:
        value = self.take(key, int, default)
        if value is not None and value < least:
            self.fail(f"'{key}' is {value}; it must be at least {least}")
        return value

    def table(self, key: str) -> Reader | None:
        value = self.take(key, dict, None)
        return None if value is None else Reader(value, f"{self.place}: [{key}]")

    def tables(self, key: str) -> list[Reader]:
        values = self.take(key, list, [])
        if not all(isinstance(value, dict) for value in values):
            self.fail(f"'{key}' must be tables: [[{key}]]")
        return [Reader(value, f"{self.place}: [[{key}]] number {i + 1}") for i, value in enumerate(values)]

    def done(self) -> None:
        for key in self._table:
            self.fail(f"nothing is called '{key}'{nearest(key, self._asked)}")


def unique(names: list[str], what: str, reader: Reader) -> None:
    for name in names:
        if names.count(name) > 1:
            reader.fail(f"two {what} are called '{name}'")


def quantity(value: Any, reader: Reader, key: str) -> tuple[float, str]:
    """Number and unit of what scene files write as 3 or "3 MPa"."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value), ""
    if isinstance(value, str):
        number, _, unit = value.strip().partition(" ")
        try:
            return float(number), unit.strip()
        except ValueError:
            pass
    reader.fail(f"'{key}' is {value!r}; it must be a number, or a number and a unit as in \"3 MPa\"")
