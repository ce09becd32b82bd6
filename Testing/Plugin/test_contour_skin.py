"""The proxy ContourSkin: labels, ports, properties, errors; on sections of a body with two legs."""
from bsrtesting import *

legs = Sphere(Center=[-1.2, 0, 0], Radius=1.0, ThetaResolution=40, PhiResolution=40)
other = Sphere(Center=[1.2, 0, 0], Radius=1.0, ThetaResolution=40, PhiResolution=40)
slices = []
for body in (legs, other):
    s = Slice(Input=body)
    s.SliceType.Normal = [0, 0, 1]
    s.SliceType.Origin = [0, 0, 0]
    s.SliceOffsetValues = [-0.8, -0.6, -0.4, -0.2, 0.0]
    slices.append(s)
both = AppendGeometry(Input=slices)
both.UpdatePipeline()

f = ContourSkin(Input=both)
check_equal((f.Tolerance, f.ConvexEnds, f.ControlPointLimit, f.Parameters, f.Degree, f.Base, f.Layout),
            (0.0, 1, 4000, "Relaxed", 3, "Automatic", "Automatic"), "defaults")
f.Base = "Open"
model = fetch(f)
check(model.GetNumberOfPolys() > 100, "a surface for each body")
check_equal(fetch(f, 2).GetNumberOfRows(), 2, "rows of the report")
check_equal(fetch(f, 3).GetNumberOfLines(), 10, "contours")
check_equal(fetch(f, 4).GetNumberOfLines(), 8, "links")
check(array(model, "RMS", "field")[0] < 0.02, "distance of the contours")
check_equal(array(model, "FoldedPatches", "field")[0], 0, "folds")

f.ControlPoints = [9, 10]
f.Parameters = "Chord"
net = fetch(f, 1)
check_equal(net.GetNumberOfPoints(), 180, "control points as asked for")

f.Degree = 9
with Errors(f) as errors:
    f.UpdatePipeline()
errors.check_one("above the Degree")
check_equal(fetch(f).GetNumberOfPoints(), 0, "nothing after an error")
