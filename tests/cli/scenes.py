"""Small scenes for tests of the command line."""

# Two compliant discs that meet within a few nanoseconds; small enough to run in about a second.
TWO_DISCS = """\
title = "Two discs"

[domain]
period = "8 um"

[time]
end = "20 ns"

[materials.soft]
law = "neo-hookean"
density = "1200 kg/m3"
young = "2 GPa"
poisson = 0.4

[shapes.disc]
kind = "disc"
diameter = "1 um"
nodes = 60

[[grains]]
shape = "disc"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [["2 um", "0 um"]] }
velocity = { uniform = ["20 m/s", "0 m/s"] }

[[grains]]
shape = "disc"
body = "compliant"
material = "soft"
packing = { kind = "positions", positions = [["3.02 um", "0.1 um"]] }

[[contacts]]
between = ["soft", "soft"]
law = "frictionless"

[[probes]]
name = "energies"
quantity = "energy"
period = "2 ns"

[frames]
period = "10 ns"
fields = ["velocity", "von_mises"]
"""


def line_of(text: str, part: str) -> int:
    """Number of the first line that contains `part`, from 1."""
    return next(number for number, line in enumerate(text.splitlines(), 1) if part in line)
