"""What the examples that picture every stage of a pipeline have in common: views, displays, field data; used by fiber.py and scan.py."""
import os

from paraview import simple as pv
from paraview.vtk.util.numpy_support import vtk_to_numpy

BUILT_PLUGIN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "lib",
                            "BSplineReconstruction", "BSplineReconstruction.so")


def new_view(size):
    """A render view on white, without axes."""
    view = pv.CreateRenderView()
    view.ViewSize = size
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = [1, 1, 1]
    return view


def show(proxy, view, color, array=None, edges=False):
    """A proxy in one color, or colored by an array (association, name)."""
    display = pv.Show(proxy, view, "GeometryRepresentation")
    display.Representation = "Surface With Edges" if edges else "Surface"
    if array is None:
        display.ColorArrayName = [None, ""]
        display.AmbientColor = display.DiffuseColor = color
    else:
        pv.ColorBy(display, array)
        display.RescaleTransferFunctionToDataRange(False, True)
        display.SetScalarBarVisibility(view, False)
    return display


def save(view, folder, name):
    """Writes name.png at the view's own size and removes the view."""
    pv.SaveScreenshot(os.path.join(folder, name + ".png"), view, ImageResolution=list(view.ViewSize))
    pv.Delete(view)


def field(data, name):
    """Field data as list of strings or flat array; None where it is absent."""
    array = data.GetFieldData().GetAbstractArray(name)
    if array is None:
        return None
    if array.IsA("vtkStringArray"):
        return [array.GetValue(i) for i in range(array.GetNumberOfValues())]
    return vtk_to_numpy(array).ravel()


def print_times(report, seconds):
    print("\nstage                   seconds")
    for name, t in zip(field(report, "StageNames"), field(report, "StageSeconds")):
        print("  %-20s %8.2f" % (name, t))
    print("  %-20s %8.2f" % ("all of it", seconds))


def print_fit(report, paths):
    """How smooth the model is, and the files written."""
    print("largest normal jump  %.2g degrees" % field(report, "MaxNormalJump")[0])
    print("folded patches       %d" % field(report, "FoldedPatches")[0])
    for p in paths:
        print("%-20s %.1f kB" % (p, os.path.getsize(p) / 1024.0))
