"""A scan cut into quads by the Morse-Smale complex of an eigenfunction, with a picture of every step.

    pvpython Examples/morse_smale.py SURFACE.vtp PICTURE.png [QUADS]

The picture shows the eigenfunction with its critical points (blue: minima, green: saddles, red: maxima), the cells of the
Morse-Smale complex, and the layout. See Documentation/MorseSmale.md.
"""
import os
import random
import sys

from paraview.simple import *

PLUGIN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "lib", "BSplineReconstruction",
                      "BSplineReconstruction.so")


def critical_points(surface, view, radius):
    for value, color in ((1, [0.1, 0.2, 0.9]), (2, [0.1, 0.65, 0.1]), (3, [0.9, 0.1, 0.1])):
        # The points alone, as no triangle has one value at all its corners.
        points = ProgrammableFilter(Input=surface, Script=f"""
import numpy
keep = numpy.where(inputs[0].PointData["Critical"] == {value})[0]
points = vtk.vtkPoints()
for i in keep:
    points.InsertNextPoint(inputs[0].Points[i])
output.SetPoints(points)
""")
        spheres = Glyph(Input=points, GlyphType="Sphere", ScaleArray=["POINTS", "No scale array"], ScaleFactor=radius,
                        GlyphMode="All Points")
        shown = Show(spheres, view)
        ColorBy(shown, ("POINTS", None))
        shown.AmbientColor = shown.DiffuseColor = color


def main(path, picture, quads):
    if "QuadRemesh" not in globals():
        LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=globals())
    scan = OpenDataFile(path)
    scan.UpdatePipeline()
    layout = QuadRemesh(Input=scan, Method="Morse-Smale", NumberOfQuads=quads)
    layout.UpdatePipeline()
    surface = OutputPort(layout, 1)
    for name in ("EigenfunctionTaken", "Minima", "Saddles", "Maxima", "MorseCells", "Irregular", "EulerCharacteristic"):
        print(name, [layout.FieldData.GetArray(name).GetRange(i)[0]
                     for i in range(layout.FieldData.GetArray(name).GetNumberOfComponents())])
    box = scan.GetDataInformation().GetBounds()
    size = max(box[1] - box[0], box[3] - box[2], box[5] - box[4])
    views = CreateLayout("Morse-Smale")
    left = CreateView("RenderView")
    AssignViewToLayout(left, views)
    middle = CreateView("RenderView")
    AssignViewToLayout(middle, views, hint=views.SplitHorizontal(0, 0.333))
    right = CreateView("RenderView")
    AssignViewToLayout(right, views, hint=views.SplitHorizontal(2, 0.5))
    views.SetSize(1800, 640)
    function = Show(surface, left)
    ColorBy(function, ("POINTS", "Eigenfunction"))
    transfer = GetColorTransferFunction("Eigenfunction")
    transfer.ApplyPreset("Cool to Warm", True)
    transfer.RescaleTransferFunction(-0.8, 0.8)
    critical_points(surface, left, 0.018 * size)
    cells = Show(surface, middle)
    ColorBy(cells, ("CELLS", "Cell"))
    table = GetColorTransferFunction("Cell")
    random.seed(3)
    colors = []
    for cell in range(int(layout.FieldData.GetArray("MorseCells").GetRange(0)[0]) + 1):
        colors += [cell] + [0.3 + 0.7 * random.random() for _ in range(3)]
    table.RGBPoints = colors
    critical_points(surface, middle, 0.018 * size)
    shown = Show(OutputPort(layout, 0), right)
    shown.SetRepresentationType("Surface With Edges")
    ColorBy(shown, ("POINTS", None))
    shown.DiffuseColor = [0.85, 0.9, 1.0]
    shown.EdgeColor = [0.0, 0.0, 0.0]
    for view in (left, middle, right):
        view.UseColorPaletteForBackground = 0
        view.Background = [1.0, 1.0, 1.0]
        view.OrientationAxesVisibility = 0
        Render(view)
    function.SetScalarBarVisibility(left, False)
    cells.SetScalarBarVisibility(middle, False)
    ResetCamera(left)
    for view in (middle, right):
        view.CameraPosition = left.CameraPosition
        view.CameraFocalPoint = left.CameraFocalPoint
        view.CameraViewUp = left.CameraViewUp
    for view in (left, middle, right):
        view.CameraViewAngle = 24
    SaveScreenshot(picture, views, ImageResolution=[1800, 640])


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) == 4 else 200)
