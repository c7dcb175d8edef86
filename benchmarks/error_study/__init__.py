"""Speed against error: scenes with converged solutions, choices, measurements, fronts, and the report of them."""
