"""A saved state brings the pipeline back: same proxies, properties and bits."""
from bsrtesting import *

f = FiberPhantom(Dimensions=[64, 32, 32], Seed=5, Collapse=0.8, OpenEnds=0)
f.UpdatePipeline()
m = Median(Input=OutputPort(f, 0), KernelSize=[3, 3, 3])
before = array(fetch(m), "CT").copy()
walls = fetch(f, 1).GetNumberOfPoints()
state = temp_file("state.pvsm")
SaveState(state)

ResetSession()
load_plugin()
LoadState(state)
sources = {key[0].rstrip("0123456789"): proxy for key, proxy in GetSources().items()}
check_equal(sorted(sources), ["FiberPhantom", "Median"], "sources of the state")
f = sources["FiberPhantom"]
check_equal((f.Seed, f.OpenEnds, list(f.Dimensions)), (5, 0, [64, 32, 32]), "properties")
check_equal(list(sources["Median"].KernelSize), [3, 3, 3], "kernel")
check(numpy.array_equal(array(fetch(sources["Median"]), "CT"), before), "the image is the same")
check_equal(fetch(f, 1).GetNumberOfPoints(), walls, "true points")
