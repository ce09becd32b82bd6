"""The fiber pipeline filter by filter, for those who want to change a stage.

    pvpython Examples/fiber_chain.py VOLUME MODEL.step

See fiber.py for the same with the one compound filter, and Documentation/FiberReconstruction.md for the stages.
"""
import os
import sys

from paraview.simple import *

PLUGIN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "lib", "BSplineReconstruction",
                      "BSplineReconstruction.so")


def main(volume, model):
    if "BSplineG1Fit" not in globals():
        LoadPlugin(os.path.abspath(PLUGIN), remote=False, ns=globals())
    image = OpenDataFile(volume)
    image.UpdatePipeline()
    # Topology: the closed object, its smooth surface.
    closing = Closing(Input=image)
    closing.UpdatePipeline()
    iso = FetchNumber(closing, "IsoValue")
    closed = Contour(Input=closing, ContourBy=["POINTS", "SignedDistance"], Isosurfaces=[0.0])
    # Geometry: the raw surface, its points told apart.
    raw = Contour(Input=image, ContourBy=["POINTS", image.PointData.GetArray(0).GetName()], Isosurfaces=[iso])
    sides = EDTClassify(Input=raw, ClosedImage=closing)
    # The layout, with rows of edges along the rims of the open ends.
    ends = FiberEnds(Input=closed, RawSurface=sides)
    quads = QuadRemesh(Input=ends, NumberOfQuads=400)
    partition = PartitionToQuads(Input=sides, Quads=quads)
    fit = BSplineG1Fit(Input=partition, Quads=quads, Rims=OutputPort(ends, 1))
    fit.UpdatePipeline()
    SaveData(model, proxy=OutputPort(fit, 0))


def FetchNumber(proxy, name):
    """A number that a filter left in its field data."""
    return proxy.FieldData.GetArray(name).GetRange(0)[0]


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
