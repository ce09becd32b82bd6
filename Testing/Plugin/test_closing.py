"""Closing in ParaView: defaults on a phantom, properties by label, contour of the result, errors."""
from bsrtesting import *

phantom = FiberPhantom(Dimensions=[96, 48, 48], Seed=3, Holes=3)
phantom.UpdatePipeline()
f = Closing(Input=OutputPort(phantom, 0))
check_equal(list(f.Scalars), ["POINTS", "CT"], "default array")
for name, value in dict(AutoIsoValue=1, AutoRadius=1, Radius=5.0, LargestComponent=1).items():
    check_equal(getattr(f, name), value, name)

image = fetch(f)
check_equal(list(field(image, "BettiNumbers")), [1, 0, 0], "Betti numbers")
check_equal(list(field(image, "BettiNumbersSurface")), [1, 0, 0], "Betti numbers of the surface")
check_between(field(image, "ClosingRadius")[0], 4, 14, "radius")
check_between(field(image, "IsoValue")[0], 14000, 24000, "iso value")
closed = array(image, "Closed")
distance = array(image, "SignedDistance")
check_equal((str(closed.dtype), str(distance.dtype)), ("uint8", "float32"), "types")
check_between(((closed > 0) != (distance < 0)).sum() / closed.sum(), 0, 0.03, "disagreement")
check(abs(distance[(closed > 0) != (distance < 0)]).max() < 1.5, "disagreement within a voxel or so")

surface = Contour(Input=f, ContourBy=["POINTS", "SignedDistance"], Isosurfaces=[0.0])
s = fetch(surface)
check_equal(s.GetNumberOfPoints() - s.GetNumberOfPolys() // 2, 2, "Euler characteristic")

# The object leaves the volume: the extent grows, and the surface is still closed.
phantom.Length = 1.3
image = fetch(f)
check(image.GetExtent()[0] < 0 and image.GetExtent()[1] > 95, "extent widened at both ends")
s = fetch(surface)
check_equal(s.GetNumberOfPoints() - s.GetNumberOfPolys() // 2, 2, "Euler characteristic, cut off")

# The settings of a person.
f.AutoRadius = 0
f.Radius = 2.5
f.AutoIsoValue = 0
f.IsoValue = 19500
image = fetch(f)
check_equal(field(image, "ClosingRadius")[0], 2.5, "radius as set")
check_equal(field(image, "IsoValue")[0], 19500, "iso value as set")

with Errors(f) as errors:
    f.IsoValue = 1e7
    f.UpdatePipeline()
    errors.check_one("iso value")
check_equal(fetch(f).GetNumberOfPoints(), 0, "points after an error")

cells = PointDatatoCellData(Input=OutputPort(phantom, 0))
cells.UpdatePipeline()
g = Closing(Input=cells)
with Errors(g) as errors:
    g.UpdatePipeline()
    errors.check_one("Cell Data to Point Data")
