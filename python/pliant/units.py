"""Readable units: values in SI come out as a factor and a label such as "um" or "MPa"."""

import math
import re

_PREFIXES = {-12: "p", -9: "n", -6: "u", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
_FACTORS = {prefix: 10.0**exponent for exponent, prefix in _PREFIXES.items()}
_PURE = ("", "-")
_UNSCALED = (*_PURE, "rad", "rad/s")


def scale(largest: float, unit: str) -> tuple[float, str]:
    """Factor and unit that bring `largest` (in `unit`, SI) to between 1 and 1000: scale(2e8, "Pa") is (1e-6, "MPa")."""
    if unit in _UNSCALED or not math.isfinite(largest) or largest == 0:
        return 1.0, unit
    exponent = 3 * math.floor(math.log10(abs(largest)) / 3 + 1e-9)
    exponent = min(max(exponent, min(_PREFIXES)), max(_PREFIXES))
    return 10.0**-exponent, _PREFIXES[exponent] + unit


def label(name: str, unit: str) -> str:
    """Axis label: name and unit in brackets, where there is one."""
    return name if unit in _PURE else f"{name} [{unit}]"


def readable(value: float, unit: str) -> str:
    """A number with its unit for captions: readable(1.25e-6, "s") is "1.25 us"."""
    factor, scaled = scale(value, unit)
    return f"{value * factor:.3g}" if unit in _PURE else f"{value * factor:.3g} {scaled}"


def length(value: str | float) -> float:
    """Metres of a length as scene files write it: length("87 um") is 8.7e-5, length(4) is 4. ValueError if none."""
    return _si(value, "m", "a length such as '87 um'", {**_FACTORS, "c": 1e-2})


def time(value: str | float) -> float:
    """Seconds of a time as scene files write it: time("4 us") is 4e-6. ValueError if none."""
    return _si(value, "s", "a time such as '4 us'", _FACTORS)


def _si(value: str | float, unit: str, what: str, factors: dict[str, float]) -> float:
    if isinstance(value, (int, float)):
        return float(value)
    match = re.fullmatch(rf"\s*([-+0-9.eE]+)\s*(.?){unit}\s*", value.replace("µ", "u").replace("μ", "u"))
    if match is None or match[2] not in factors:
        raise ValueError(f"'{value}' is not {what}")
    return float(match[1]) * factors[match[2]]
