"""Fiber Reconstruction in one click: a small damaged phantom against its true walls."""
from bsrtesting import *
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

f = FiberPhantom(Dimensions=[96, 48, 48], Seed=3, Holes=3, Debris=8)
f.UpdatePipeline()
r = FiberReconstruction(Input=OutputPort(f, 0), NumberOfQuads=120)
with Errors(r) as errors:
    model = fetch(r, 0)
errors.check_none()

patches = array(model, "SplinePatches", "field")
check_equal(patches.shape[1], 8, "columns of SplinePatches")
check_equal(array(model, "SplineControlPoints", "field").shape[1], 4, "columns of SplineControlPoints")
check_equal(array(model, "SplineNeighbors", "field").shape, (len(patches), 4), "SplineNeighbors")
check_equal(field(model, "SplineVersion")[0], 1, "version")
check((array(model, "SplineNeighbors", "field") >= 0).all(), "every side has a neighbor")
check_equal(field(model, "FoldedPatches")[0], 0, "folded patches")
check_between(field(model, "MaxNormalJump")[0], 0, 0.01, "normal jump in degrees")
check_equal(fetch(r, 2).GetNumberOfRows(), len(patches), "rows of the report")

# From every seventh true point to the model.
locator = vtkStaticCellLocator()
locator.SetDataSet(model)
locator.BuildLocator()
walls = fetch(f, 1)
true = points(walls)[::7]
side = array(walls, "Side")[::7]
closest, cell, sub, square = [0.0] * 3, mutable(0), mutable(0), mutable(0.0)
distance = numpy.empty(len(true))
for i, p in enumerate(true):
    locator.FindClosestPoint(p, closest, cell, sub, square)
    distance[i] = square.get() ** 0.5
for s, name in enumerate(("outer", "inner")):
    d = distance[side == s]
    print("%s wall: RMS %.3f, 95%% %.3f voxels" % (name, numpy.sqrt((d**2).mean()), numpy.percentile(d, 95)))
    check_between(numpy.sqrt((d**2).mean()), 0, 1.0, "RMS distance of the true %s wall" % name)
