"""Just-in-time compilation in the results folder, safe for concurrent processes and after a kill."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager

import ufl
from dolfinx import fem, jit
from dolfinx.mesh import Mesh

from verification import OUT

CACHE = OUT / ".fenics"
jit.DOLFINX_DEFAULT_JIT_PARAMETERS["cache_dir"] = (str(CACHE), "Path for storing DOLFINx JIT cache.")


@contextmanager
def compiling() -> Iterator[None]:
    """Lock for one process at a time. Unfinished files of a killed process would block dolfinx and are removed."""
    CACHE.mkdir(parents=True, exist_ok=True)
    with (CACHE / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        for source in CACHE.glob("*.c"):
            if not source.with_suffix(".c.cached").exists():
                source.unlink()
        yield


def compile_form(form: ufl.Form) -> fem.FormMetaClass:
    with compiling():
        return fem.form(form)


def vector_space(domain: Mesh, degree: int) -> fem.FunctionSpace:
    """Continuous vectors, Lagrange elements of that degree."""
    with compiling():
        return fem.VectorFunctionSpace(domain, ("Lagrange", degree))
