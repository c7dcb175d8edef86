"""The runs of a study: which values each has, and what it is called."""

from __future__ import annotations

import hashlib
import itertools
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from pliant.study.spec import Study, between

LONGEST_NAME = 80


@dataclass
class Point:
    values: dict[str, Any]  # by name, replicas included
    sets: dict[str, Any]  # by path in the scene

    @property
    def name(self) -> str:
        """Of its folder: it does not change when a study gets other values beside these."""
        text = ",".join(f"{name}={value}" for name, value in self.values.items()) or "as_it_is"
        plain = re.sub(r"[^A-Za-z0-9.=,+-]+", "_", text)
        if plain == text and len(plain) <= LONGEST_NAME:
            return plain
        return f"{plain[:LONGEST_NAME - 9]}-{hashlib.sha256(text.encode()).hexdigest()[:8]}"


def points_of(study: Study) -> list[Point]:
    """In the order of the file, the last parameter changing fastest; replicas of each beside each other."""
    if study.combine == "latin hypercube":
        combinations = _hypercube(study)
    elif study.combine == "zip":
        combinations = list(zip(*(p.values for p in study.parameters)))
    else:
        combinations = list(itertools.product(*(p.values for p in study.parameters)))
    all_points = []
    for combination in combinations or [()]:
        for seed in study.replicas.values if study.replicas else [None]:
            chosen = list(zip(study.parameters, combination))
            if study.replicas:
                chosen.append((study.replicas, seed))
            all_points.append(Point({p.name: value for p, value in chosen},
                                    study.fixed | {path: value for p, value in chosen for path in p.paths}))
    return all_points


def _hypercube(study: Study) -> list[tuple]:
    """Each parameter's range in as many strata as there are samples, one sample in each (McKay, Beckman, Conover 1979)."""
    random = np.random.default_rng(study.seed)
    n = study.samples
    columns = []
    for p in study.parameters:
        assert p.limits is not None
        shares = (random.permutation(n) + random.random(n)) / n
        first, last, unit = p.limits
        columns.append([between(first, last, float(share), unit, p.logarithmic) for share in shares])
    return list(zip(*columns))
