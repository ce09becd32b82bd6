"""Five of twenty phantoms, every second with closed ends: every model valid, close to the true walls."""
from fiberseeds import run_seeds

run_seeds(range(1, 6), mean_rms=0.7)
