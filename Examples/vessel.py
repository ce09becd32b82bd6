"""Contours of a branching vessel to one smooth B-spline surface, written to STEP.

    pvpython Examples/vessel.py [CONTOURS MODEL.step]

CONTOURS is a file of polylines (.vtp); without it the script makes those of a vessel that parts in two.
Prints what the report says; see Documentation/BranchedContourSurface.md.
"""
import os
import sys

from paraview.simple import *

PLUGIN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "lib", "BSplineReconstruction",
                      "BSplineReconstruction.so")

# Two branches that come together (10 slices) and a trunk (8 slices), 0.8 apart.
VESSEL = """
import math
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray
points, lines = vtkPoints(), vtkCellArray()
def ring(x, y, z, a, b, n):
    ids = [points.InsertNextPoint(x + a * math.cos(2 * math.pi * i / n), y + b * math.sin(2 * math.pi * i / n), z)
           for i in range(n)]
    lines.InsertNextCell(n + 1)
    for i in ids + ids[:1]:
        lines.InsertCellPoint(i)
for s in range(10):
    x = 1.75 + 0.03 * (9 - s) ** 2
    ring(-x, 0.02 * s, 0.8 * s, 1.5, 1.6, 48)
    ring(x, -0.02 * s, 0.8 * s, 1.3, 1.4, 40)
for s in range(8):
    ring(0.1 * s, 0.0, 0.8 * (10 + s), 3.3 - 0.12 * s, 2.0 + 0.1 * s, 72)
output.SetPoints(points)
output.SetLines(lines)
"""


def number(proxy, name, component=0):
    return proxy.FieldData.GetArray(name).GetRange(component)[0]


def main(contours, model):
    if "BranchedContourSurface" not in globals():
        LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=globals())
    source = OpenDataFile(contours) if contours else ProgrammableSource(Script=VESSEL, OutputDataSetType="vtkPolyData")
    source.UpdatePipeline()
    surface = BranchedContourSurface(Input=source)
    surface.UpdatePipeline()
    print("junctions %d, open sides %d, folded patches %d" % (number(surface, "Junctions"), number(surface, "OpenSides"),
                                                              number(surface, "FoldedPatches")))
    print("largest angle between tangent planes %.2g degrees" % number(surface, "MaxNormalJump"))
    print("distance of the contours' points: RMS %.3g, largest %.3g" % (number(surface, "RMS"), number(surface, "Max")))
    if model:
        SaveData(model, proxy=OutputPort(surface, 0))
    return surface


if __name__ == "__main__":
    if len(sys.argv) not in (1, 3):
        sys.exit(__doc__)
    main(*(sys.argv[1:] or (None, None)))
