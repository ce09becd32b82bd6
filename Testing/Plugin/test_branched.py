"""BranchedContourSurface: the example, real contours, and one error for each bad input."""
import importlib.util
import math

from bsrtesting import *

example = importlib.util.spec_from_file_location("vessel", os.path.join(SOURCE_DIR, "Examples", "vessel.py"))
vessel = importlib.util.module_from_spec(example)
example.loader.exec_module(vessel)
vessel.__dict__.update({n: globals()[n] for n in ("BranchedContourSurface",)})

surface = vessel.main(None, None)
check_equal((surface.OrderU, surface.OrderV, surface.Junction, surface.Knots, surface.Interpolate),
            (3, 3, "Automatic", "Uniform", 1), "defaults")
model = fetch(surface)
check_equal(field(model, "Junctions")[0], 1, "junctions")
check_equal(field(model, "FoldedPatches")[0], 0, "folded patches")
check_between(field(model, "MaxNormalJump")[0], 0.0, 1e-6, "largest normal jump")
check_between(field(model, "ResliceThere").max(), 0.0, 0.1, "re-slicing")
patches = len(field(model, "SplinePatches")) // 8
net = fetch(surface, 1)
check_equal(net.GetNumberOfPoints(), len(field(model, "SplineControlPoints")) // 4, "control net")
report = fetch(surface, 2)
check_equal(report.GetNumberOfRows(), patches, "rows of the report")

surface.Junction = "Superimposed C0"
check(field(fetch(surface), "JunctionNormalJump")[0] > 5.0, "a C0 junction has a crease")
surface.Junction = "Shared Edge G1"
surface.Tangency = "As Published"
check(field(fetch(surface), "JunctionNormalJump")[0] > 5.0, "as published: creased in space")
surface.Tangency = "In Space"
check(field(fetch(surface), "JunctionNormalJump")[0] < 1e-6, "smooth in space")


def lines(script):
    source = ProgrammableSource(OutputDataSetType="vtkPolyData", Script="""
import math
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray
points, cells = vtkPoints(), vtkCellArray()
def line(coordinates):
    cells.InsertNextCell(len(coordinates))
    for c in coordinates:
        cells.InsertCellPoint(points.InsertNextPoint(*c))
def ring(x, z, r=1.0, n=30, squeeze=1.0):
    p = [(x + r * math.cos(2 * math.pi * i / n), squeeze * r * math.sin(2 * math.pi * i / n), z) for i in range(n)]
    line(p + p[:1])
""" + script + """
output.SetPoints(points)
output.SetLines(cells)
""")
    source.UpdatePipeline()
    return source


BAD = [("", "no polyline"), ("line([(0, 0, 0)])", "speck"), ("ring(0, 0)", "two slices"),
       ("ring(0, 0); ring(0, 1); line([(0,0,2), (1,0,2), (0,1,2), (1,1,2), (0,0,2)])", "crosses itself"),
       ("ring(0, 0); ring(0, 1); ring(1.2, 1)", "cross each other"),
       ("for s in range(4):\n    p = [(math.cos(a / 5), math.sin(a / 5), s + 0.6 * math.sin(a / 2.5)) for a in range(31)]\n"
        "    line(p + p[:1])", "not planar"),
       ("ring(0, 0); ring(50, 1)", "linked"),
       ("line([(0,0,0), (1,0,0), (1,1,0), (2,1,0)]); line([(0,0,1), (1,0,1), (1,1,1), (2,1,1)])", "linked")]
for script, text in BAD:
    f = BranchedContourSurface(Input=lines(script), EndCaps="No Ends")
    with Errors(f) as errors:
        f.UpdatePipeline()
    errors.check_one(text)
    check_equal(fetch(f).GetNumberOfPoints(), 0, "points after an error")
for name, value, text in (("OrderU", 2, "OrderU"), ("OrderV", 9, "OrderV"), ("PointsPerSection", 3, "PointsPerSection"),
                          ("JunctionPosition", 2.0, "JunctionPosition"), ("MinimumOverlap", 0.0, "MinimumOverlap")):
    f = BranchedContourSurface(Input=lines("ring(0, 0); ring(0, 1); ring(0, 2)"))
    setattr(f, name, value)
    with Errors(f) as errors:
        f.UpdatePipeline()
    errors.check_one(text)

for name, tubes, folded in (("contours_vmtk_aorta_y", 3, 0), ("contours_femur12_z", 5, 0)):
    f = BranchedContourSurface(Input=OpenDataFile(shared_data(name + ".vtp")))
    model = fetch(f)
    check_equal(field(model, "Tubes")[0], tubes, name + " tubes")
    check_equal(field(model, "FoldedPatches")[0], folded, name + " folded patches")
    check(field(model, "MaxNormalJump")[0] < 1e-6, name + " is smooth")
    there = field(model, "ResliceThere")
    check(there[3] < 0.08, name + " re-slicing, 95 %%: %g" % there[3])
