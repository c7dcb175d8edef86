"""Pictures of a result folder. pliant.results reads, `maps` draws bodies, `curves` draws histories."""
