"""From contours that split and merge to one smooth B-spline surface.

    pvpython Examples/femur.py [CONTOURS] [--object circles|rectangles] [--output out] [--plugin FILE]

CONTOURS is a file of polylines (.vtp, .vtk). Without it one of the objects of paper 004 is made: 14 slices, two legs
below, one base above. Writes model.vtp, model.step, report.csv, femur.pvsm and pictures into the output folder.
"""
import argparse
import csv
import math
import os
import sys

from paraview import simple as pv
from paraview import servermanager as sm

BUILT_PLUGIN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "lib",
                            "BSplineReconstruction", "BSplineReconstruction.so")
OBJECTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "objects.csv")
MAKE = '''
import math, vtk
points, lines = vtk.vtkPoints(), vtk.vtkCellArray()
points.SetDataTypeToDouble()
def add(ellipse, x, z, a, b, n):
    ids = []
    for i in range(n):
        if ellipse:
            t = 2 * math.pi * i / n
            p = (x + a * math.cos(t), b * math.sin(t), z)
        else:
            side, t = divmod(4.0 * i / n, 1.0)
            c = [(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]
            u, v = c[int(side)], c[int(side) + 1]
            p = (x + a * (u[0] + t * (v[0] - u[0])), b * (u[1] + t * (v[1] - u[1])), z)
        ids.append(points.InsertNextPoint(p))
    lines.InsertNextCell(n + 1, ids + ids[:1])
for ellipse, x, z, a, b, n in %r:
    add(ellipse, x, z, a, b, n)
self.GetOutput().SetPoints(points)
self.GetOutput().SetLines(lines)
'''


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("contours", nargs="?")
    p.add_argument("--object", choices=["circles", "rectangles"], default="circles")
    p.add_argument("--output", default="out", help="folder for the results")
    p.add_argument("--tolerance", type=float, default=0.0)
    p.add_argument("--plugin", default=BUILT_PLUGIN, help="BSplineReconstruction.so, if ParaView does not load it by itself")
    return p.parse_args()


def source_of(a):
    if a.contours is None:
        with open(OBJECTS, newline="") as f:
            rows = [(r["shape"] == "ellipse", *(float(r[k]) for k in ("x", "z", "a", "b")), int(r["points"]))
                    for r in csv.DictReader(f) if r["object"] == a.object]
        return pv.ProgrammableSource(OutputDataSetType="vtkPolyData", Script=MAKE % (rows,))
    if not os.path.exists(a.contours):
        sys.exit("femur.py: there is no file " + a.contours)
    return pv.OpenDataFile(a.contours)


def picture(proxies, up, name, folder):
    view = pv.CreateRenderView()
    view.ViewSize = [1400, 1000]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = [1, 1, 1]
    for proxy, color in proxies:
        d = pv.Show(proxy, view)
        d.ColorArrayName = [None, ""]
        d.AmbientColor = d.DiffuseColor = color
        d.Representation = "Surface"
        d.LineWidth = 2
        d.Specular = 0.3
    side = [1 if i == (up + 1) % 3 else 0 for i in range(3)]
    other = [1 if i == (up + 2) % 3 else 0 for i in range(3)]
    view.CameraPosition = [1.0 * side[i] + 1.6 * other[i] - (0.7 if i == up else 0) for i in range(3)]
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraViewUp = [1 if i == up else 0 for i in range(3)]
    view.ResetCamera()
    pv.SaveScreenshot(os.path.join(folder, name + ".png"), view, ImageResolution=[1400, 1000])


def main():
    a = arguments()
    os.makedirs(a.output, exist_ok=True)
    if os.path.exists(a.plugin):
        pv.LoadPlugin(a.plugin, remote=False, ns=vars(pv))
    source = source_of(a)
    source.UpdatePipeline()
    skin = pv.ContourSkin(Input=source, Tolerance=a.tolerance)
    skin.UpdatePipeline()
    model = sm.Fetch(skin, idx=0)
    if model.GetNumberOfPoints() == 0:
        sys.exit("femur.py: no surface; see the error above")
    table = sm.Fetch(skin, idx=2)
    for r in range(table.GetNumberOfRows()):
        row = {table.GetColumnName(c): table.GetValue(r, c).ToDouble() for c in range(table.GetNumberOfColumns())}
        net = ("%d x %d control points" % (row["ControlPointsU"], row["ControlPointsV"]) if row["ControlPointsU"]
               else "tubes and junctions")
        print("surface %d: %d contours, %s, %d patch(es), RMS %.4g, average error %.4g, resliced %.4g (RMS), "
              "second derivatives jump by %.1e" %
              (r, row["Contours"], net, row["Patches"], row["RMS"], row["AverageError"], row["ResliceRMS"],
               row["SecondDerivativeJump"]))
    message = model.GetFieldData().GetAbstractArray("Message").GetValue(0)
    if message:
        print(message)
    planes = sm.Fetch(skin, idx=3)
    lines = [planes.GetCell(i).GetBounds() for i in range(planes.GetNumberOfCells())]
    thickness = [math.fsum(b[2 * k + 1] - b[2 * k] for b in lines) for k in range(3)]
    up = sorted(range(3), key=lambda k: thickness[k])[0]
    contours = pv.OutputPort(skin, 3)
    picture([(contours, [0.75, 0.1, 0.1])], up, "contours", a.output)
    picture([(pv.OutputPort(skin, 0), [0.86, 0.82, 0.74])], up, "surface", a.output)
    picture([(pv.OutputPort(skin, 0), [0.86, 0.82, 0.74]), (contours, [0.75, 0.1, 0.1])], up, "both", a.output)
    pv.SaveData(os.path.join(a.output, "model.vtp"), proxy=pv.OutputPort(skin, 0))
    pv.SaveData(os.path.join(a.output, "model.step"), proxy=pv.OutputPort(skin, 0))
    pv.SaveData(os.path.join(a.output, "report.csv"), proxy=pv.OutputPort(skin, 2))
    pv.SaveState(os.path.join(a.output, "femur.pvsm"))


main()
