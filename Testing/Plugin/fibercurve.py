"""RMS of the fiber pipeline against the truth over the number of patches; not a test.

    BSR_PLUGIN=.../BSplineReconstruction.so pvpython Testing/Plugin/fibercurve.py VOLUME.vti TRUTH.json 100,200,300

TRUTH.json holds the true walls as rings of points, "outer_points" and "inner_points"; 6 % of the rings at either end are
left out. Prints a table in Markdown: quads asked, patches a shell, RMS and 95th percentile of the distance from the
true points to the model in voxels, seconds of the pipeline. Run it with the plugins of two versions to compare them.
"""
import json
import os
import sys

import numpy as np
from paraview import servermanager as sm
from paraview import simple as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

TRIM = 0.06


def cloud(rings):
    """The points of the rings, without those at the ends."""
    cut = int(round(TRIM * len(rings)))
    points = vtkPoints()
    for ring in rings[cut:len(rings) - cut]:
        for p in ring:
            points.InsertNextPoint(p)
    data = vtkPolyData()
    data.SetPoints(points)
    producer = pv.TrivialProducer()
    producer.GetClientSideObject().SetOutput(data)
    return producer


def main(volume, truth, quads):
    pv.LoadPlugin(os.environ["BSR_PLUGIN"], remote=False, ns=globals())
    with open(truth, encoding="utf-8") as f:
        walls = json.load(f)
    image = pv.OpenDataFile(volume)
    image.UpdatePipeline()
    voxel = min(walls["spacing"]) if isinstance(walls["spacing"], list) else walls["spacing"]
    print("| asked | patches a shell | outer RMS / p95 | inner RMS / p95 | s |\n|---|---|---|---|---|")
    for asked in quads:
        image.UpdatePipeline()
        pv.SetActiveSource(image)
        fiber = FiberReconstruction(Input=image, NumberOfQuads=asked)
        fiber.UpdatePipeline()
        cell_data = sm.Fetch(fiber, idx=0).GetCellData()
        shell, patch = (vtk_to_numpy(cell_data.GetArray(n)) for n in ("Shell", "PatchId"))
        cells = ["%d" % asked, "%d" % len(np.unique(patch[shell == 0]))]
        for name in ("outer_points", "inner_points"):
            deviation = SplineDeviation(Input=cloud(walls[name]), Model=fiber)
            deviation.UpdatePipeline()
            d = np.abs(vtk_to_numpy(sm.Fetch(deviation).GetPointData().GetArray("Deviation"))) / voxel
            cells.append("%.3f / %.3f" % (float(np.sqrt((d ** 2).mean())), float(np.percentile(d, 95))))
        cells.append("%.1f" % sm.Fetch(fiber, idx=2).GetFieldData().GetArray("Seconds").GetValue(0))
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], [int(n) for n in sys.argv[3].split(",")])
