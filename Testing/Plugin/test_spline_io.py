"""Partition, resampling, Bezier cells, deviation and CAD files of a spline model, in ParaView."""
import os

from bsrtesting import *
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkPolyData

load_plugin()


def torus():
    """The exact torus with radii 3 and 1 as 16 rational biquadratic patches."""
    circle = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    half = 0.5 ** 0.5
    patches, points, neighbors = [], [], []
    for b in range(4):
        for a in range(4):
            patches.append((0, 2, 2, 3, 3, len(points), 0, 0))
            side = lambda i, j, s: 4 * (4 * (j % 4) + i % 4) + s
            neighbors.append((side(a, b - 1, 2), side(a + 1, b, 3), side(a, b + 1, 0), side(a - 1, b, 1)))
            for j in range(2 * b, 2 * b + 3):
                for i in range(2 * a, 2 * a + 3):
                    (c, s), (d, z) = circle[i], circle[j]
                    points.append(((3 + d) * c, (3 + d) * s, z, (half if i % 2 else 1) * (half if j % 2 else 1)))
    data = vtkPolyData()
    for name, rows, kind in (
        ("SplinePatches", patches, numpy.int64),
        ("SplineControlPoints", points, float),
        ("SplineKnots", [0, 0, 0, 1, 1, 1], float),
        ("SplineNeighbors", neighbors, numpy.int64),
        ("SplineVersion", [1], numpy.int64),
    ):
        a = numpy_to_vtk(numpy.array(rows, kind), deep=True)
        a.SetName(name)
        data.GetFieldData().AddArray(a)
    return data


source = TrivialProducer()
source.GetClientSideObject().SetOutput(torus())

# Resampled, with curvatures.
model = SplineSample(Input=source, Resolution=8)
data = fetch(model)
check(data.GetNumberOfCells() == 16 * 64 and data.GetNumberOfPoints() == 16 * 64, "closed mesh")
check_close(array(data, "GaussCurvature").max(), 0.25, 1e-6, "largest Gauss curvature")
check_close(array(data, "MeanCurvature").min(), 0.25, 1e-6, "smallest mean curvature")

# Bezier cells.
cells = fetch(SplineToBezier(Input=model))
check(cells.GetNumberOfCells() == 16 and cells.GetCellType(0) == 77, "Bezier cells")

# Deviation of a sphere's points.
ball = Sphere(Radius=5.0, ThetaResolution=16, PhiResolution=16)
deviation = fetch(SplineDeviation(Input=ball, Model=model))
p = points(deviation)
truth = numpy.hypot(numpy.hypot(p[:, 0], p[:, 1]) - 3, p[:, 2]) - 1
check_close(abs(array(deviation, "Deviation") - truth).max(), 0.0, 1e-6, "deviation")
check_close(field(deviation, "Max")[0], truth.max(), 1e-6, "largest deviation")

# Partition to the quads of a plane.
plane = Plane(XResolution=3, YResolution=3)
parts = fetch(PartitionToQuads(Input=ball, Quads=plane, Method="Nearest Quad"))
check(array(parts, "QuadId").max() == 8 and array(parts, "UV").max() <= 1.0, "partition")

# CAD files by Save Data.
for name, mark in (("torus.step", "MANIFOLD_SOLID_BREP"), ("torus.stp", "MICRO"), ("torus.igs", ""), ("torus.iges", "")):
    path = temp_file(name)
    if os.path.exists(path):
        os.remove(path)
    SaveData(path, proxy=model, Units="um" if name.endswith("stp") else "mm")
    check(os.path.getsize(path) > 10000, name + " was written")
    with open(path) as f:
        check(mark in f.read(), "%s holds %s" % (name, mark))
    os.remove(path)
print("OK")
