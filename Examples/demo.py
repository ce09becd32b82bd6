"""Runs the example that fits a file: a volume, a scan or a stack of contours.

    pvpython Examples/demo.py [FILE [OPTIONS]] [--output out] [--plugin FILE]

Volumes go to fiber.py, surfaces and points to scan.py, polylines to femur.py, with all options; without a file a digital
fiber is made. Each writes model.vtp, model.step, report.csv and pictures into the output folder and prints a summary.
"""
import os
import runpy
import sys

from paraview import simple as pv

HERE = os.path.dirname(os.path.abspath(__file__))


def kind_of(path):
    """The example's name for the data in a file."""
    if not os.path.exists(path):
        sys.exit("demo.py: there is no file " + path)
    source = pv.OpenDataFile(path)
    if source is None:
        sys.exit("demo.py: ParaView has no reader for " + path)
    source.UpdatePipeline()
    data = source.GetClientSideObject().GetOutputDataObject(0)
    kind, lines = data.GetClassName(), 0
    if kind == "vtkPolyData" and data.GetNumberOfPolys() + data.GetNumberOfStrips() == 0:
        lines = data.GetNumberOfLines()
    pv.Delete(source)
    if kind == "vtkImageData":
        return "fiber.py"
    if kind != "vtkPolyData":
        sys.exit("demo.py: %s holds a %s; give an image, a surface, points or polylines" % (path, kind))
    return "femur.py" if lines else "scan.py"


def main():
    arguments = sys.argv[1:]
    script = "fiber.py"
    if arguments and not arguments[0].startswith("-"):
        script = kind_of(arguments[0])
    sys.argv = [os.path.join(HERE, script)] + arguments
    runpy.run_path(sys.argv[0], run_name="__main__")


main()
