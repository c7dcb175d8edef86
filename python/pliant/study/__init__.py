"""Studies: many runs of one scene, what comes of them in a table, figures and a report. `./pliant study --help`."""
