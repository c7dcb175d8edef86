"""Pictures of a result folder. run_data.py reads, `maps` draws bodies, `curves` draws histories."""
