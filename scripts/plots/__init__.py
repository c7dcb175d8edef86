"""Pictures of a result folder. `run_data` reads, `maps` draws bodies, `curves` draws histories."""
