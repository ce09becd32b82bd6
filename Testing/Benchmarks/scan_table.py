#!/usr/bin/env python3
"""The tables of Documentation/ScanToNURBS.md: scans to NURBS by counts of patches, optimizers and layout methods.

    PYTHONPATH=build/lib/python3/dist-packages python3 Testing/Benchmarks/scan_table.py TABLE DATA_FOLDER ROWS.csv

TABLE: counts | weights | methods | shapes. Each run is one line of ROWS.csv; lines that are there are not run again, so that a
long table can be made in parts. Prints the table as Markdown. Seconds are processor seconds of all threads.
"""
import csv
import math
import os
import sys
import time

import bsplinereconstruction  # noqa: F401 (loads the libraries)
from bsplinereconstruction.BSplineReconstructionFilters import vtkScanToNURBS
from vtkmodules.vtkCommonComputationalGeometry import vtkParametricEllipsoid, vtkParametricTorus
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFlyingEdges3D, vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkParametricFunctionSource, vtkSphereSource
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

SCANS = ("stanford-bunny", "rocker-arm", "mechpart_recon", "femur_12", "distcap", "tooth")
OPTIMIZERS = ("None", "Evolution Strategy", "Deterministic", "Control Points")
METHODS = ("Field Aligned", "Morse-Smale")
COLUMNS = ("key", "patches", "points", "euler", "irregular", "distortion", "failed", "folded", "jump", "rms", "max",
           "seconds", "message")


def scan(folder, name):
    """A scan by its name; the tooth is an isosurface."""
    if name == "tooth":
        volume = vtkXMLImageDataReader()
        volume.SetFileName(os.path.join(folder, "tooth.vti"))
        iso = vtkFlyingEdges3D()
        iso.SetInputConnection(volume.GetOutputPort())
        iso.SetValue(0, 560)
        iso.ComputeNormalsOff()
        iso.Update()
        return largest(iso.GetOutput())
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(os.path.join(folder, name + ".vtp"))
    reader.Update()
    return reader.GetOutput()


def largest(surface):
    from vtkmodules.vtkFiltersCore import vtkPolyDataConnectivityFilter
    part = vtkPolyDataConnectivityFilter()
    part.SetInputData(surface)
    part.SetExtractionModeToLargestRegion()
    used = vtkCleanPolyData()
    used.SetInputConnection(part.GetOutputPort())
    used.PointMergingOff()
    used.ConvertPolysToLinesOff()
    used.Update()
    return used.GetOutput()


def shape(name):
    """Analytic shapes of fine triangles."""
    if name == "sphere":
        source = vtkSphereSource()
        source.SetThetaResolution(200)
        source.SetPhiResolution(150)
    elif name == "double torus":
        return double_torus()
    else:
        function = vtkParametricTorus() if name == "torus" else vtkParametricEllipsoid()
        if name == "torus":
            function.SetRingRadius(1.0)
            function.SetCrossSectionRadius(0.4)
        else:
            function.SetXRadius(1.0)
            function.SetYRadius(0.7)
            function.SetZRadius(0.5)
        source = vtkParametricFunctionSource()
        source.SetParametricFunction(function)
        source.SetUResolution(200)
        source.SetVResolution(150)
    weld = vtkCleanPolyData()
    weld.SetInputConnection(source.GetOutputPort())
    weld.SetTolerance(1e-6)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(weld.GetOutputPort())
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    triangles.Update()
    return triangles.GetOutput()


def double_torus():
    """(x (x - 1)^2 (x - 2) + y^2)^2 + z^2 = 0.01, points moved onto it by Newton steps."""
    import numpy
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    def f(p):
        x, y, z = p.T
        return (x * (x - 1)**2 * (x - 2) + y**2)**2 + z**2 - 0.01

    n = (150, 90, 30)
    low, high = numpy.array((-0.2, -0.8, -0.2)), numpy.array((2.2, 0.8, 0.2))
    axes = [numpy.linspace(low[a], high[a], n[a]) for a in range(3)]
    grid = numpy.stack(numpy.meshgrid(*axes, indexing="ij"), -1)
    image = vtkImageData()
    image.SetDimensions(*n)
    image.SetOrigin(*low)
    image.SetSpacing(*((high - low) / (numpy.array(n) - 1)))
    values = f(grid.reshape(-1, 3)).reshape(n).transpose(2, 1, 0).ravel()
    scalars = numpy_to_vtk(values, deep=1)
    scalars.SetName("f")
    image.GetPointData().SetScalars(scalars)
    iso = vtkFlyingEdges3D()
    iso.SetInputData(image)
    iso.SetValue(0, 0.0)
    iso.ComputeNormalsOff()
    iso.Update()
    surface = iso.GetOutput()
    p = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    for _ in range(8):
        h = 1e-6
        g = numpy.stack([(f(p + h * e) - f(p - h * e)) / (2 * h) for e in numpy.eye(3)], -1)
        p -= (f(p) / (g**2).sum(1))[:, None] * g
    surface.GetPoints().SetData(numpy_to_vtk(p, deep=1))
    return surface


def distortion(layout):
    """Mean deviation of the layout's corners from 90 degrees."""
    total = 0.0
    for c in range(layout.GetNumberOfCells()):
        ids = layout.GetCell(c).GetPointIds()
        p = [layout.GetPoint(ids.GetId(k)) for k in range(4)]
        for k in range(4):
            a = [x - y for x, y in zip(p[(k + 1) % 4], p[k])]
            b = [x - y for x, y in zip(p[(k + 3) % 4], p[k])]
            cosine = sum(x * y for x, y in zip(a, b)) / max(1e-300, math.hypot(*a) * math.hypot(*b))
            total += abs(math.degrees(math.acos(max(-1.0, min(1.0, cosine)))) - 90.0)
    return total / (4.0 * layout.GetNumberOfCells())


def run(key, data, **options):
    nurbs = vtkScanToNURBS()
    nurbs.SetInputDataObject(0, data)
    for name, value in options.items():
        getattr(nurbs, "Set" + name)(value)
    began = time.process_time()
    nurbs.Update()
    seconds = time.process_time() - began
    report = nurbs.GetOutputDataObject(vtkScanToNURBS.REPORT)
    row = dict.fromkeys(COLUMNS, "")
    row.update(key=key, seconds="%.1f" % seconds, patches=report.GetNumberOfRows())
    if report.GetNumberOfRows() > 0:
        def field(name):
            return report.GetFieldData().GetArray(name).GetComponent(0, 0)
        layout = nurbs.GetOutputDataObject(vtkScanToNURBS.LAYOUT)
        row.update(points=nurbs.GetOutputDataObject(vtkScanToNURBS.POINTS).GetNumberOfPoints(),
                   euler=int(field("EulerCharacteristic")), irregular=int(field("Irregular")),
                   distortion="%.1f" % distortion(layout), failed=int(field("FailedQuads")),
                   folded=int(field("FoldedPatches")), jump="%.1e" % field("MaxNormalJump"),
                   rms="%.2e" % field("RelativeRMS"), max="%.2e" % field("RelativeMax"))
    else:
        row["message"] = "no result"
    return row


def cases(table, folder):
    """(key, data function, options) of every row."""
    if table == "counts":
        for name in ("stanford-bunny",):
            for count in (27, 50, 100, 200, 391):
                yield "%s %d" % (name, count), lambda name=name: scan(folder, name), dict(NumberOfQuads=count)
    elif table == "weights":
        for name in SCANS:
            for index, optimizer in enumerate(OPTIMIZERS):
                yield "%s %s" % (name, optimizer), lambda name=name: scan(folder, name), dict(
                    NumberOfQuads=100, Optimizer=index)
    elif table == "methods":
        for name in SCANS:
            for index, method in enumerate(METHODS):
                yield "%s %s" % (name, method), lambda name=name: scan(folder, name), dict(
                    NumberOfQuads=200, Method=index)
    elif table == "shapes":
        for name in ("sphere", "torus", "double torus", "ellipsoid"):
            for count in (24, 96, 384):
                yield "%s %d" % (name, count), lambda name=name: shape(name), dict(NumberOfQuads=count)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    table, folder, path = sys.argv[1:]
    done = {}
    if os.path.exists(path):
        with open(path, newline="") as file:
            done = {row["key"]: row for row in csv.DictReader(file)}
    fresh = not os.path.exists(path)
    rows = []
    for key, data, options in cases(table, folder):
        if key not in done:
            done[key] = run(key, data(), **options)
            with open(path, "a", newline="") as file:
                writer = csv.DictWriter(file, COLUMNS)
                if fresh:
                    writer.writeheader()
                    fresh = False
                writer.writerow(done[key])
        rows.append(done[key])
        print("| " + " | ".join(str(done[key][c]) for c in COLUMNS) + " |", flush=True)
    return rows


if __name__ == "__main__":
    main()
