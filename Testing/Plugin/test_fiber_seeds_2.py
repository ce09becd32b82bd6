"""Five of twenty phantoms, every second with closed ends: every model valid, close to the true walls."""
from fiberseeds import run_seeds

run_seeds(range(6, 11), mean_rms=0.7)
