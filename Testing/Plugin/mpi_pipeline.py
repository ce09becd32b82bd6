"""Two processes: filters that need the whole get it, and their results are those of one process."""
import os

from bsplinereconstruction import vtkFiberPhantom, vtkFiberReconstruction  # before other objects
from bsrtesting import *
from paraview.modules.vtkRemotingCore import vtkProcessModule
from vtkmodules.vtkParallelCore import vtkMultiProcessController

rank = vtkProcessModule.GetProcessModule().GetPartitionId()
check_equal(vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses(), 2, "processes")


def sizes(proxy, port=0):
    """Points and cells of all pieces together; the points here."""
    output = OutputPort(proxy, port)
    output.UpdatePipeline()
    info = output.GetDataInformation()
    here = proxy.GetClientSideObject().GetOutputDataObject(port)
    return (info.GetNumberOfPoints(), info.GetNumberOfCells()), here.GetNumberOfPoints()


phantom = FiberPhantom(Dimensions=[64, 48, 48], Seed=4)
whole = FiberReconstruction(Input=OutputPort(phantom, 0), NumberOfQuads=60)
model, here = sizes(whole)
check(here == (model[0] if rank == 0 else 0), "the first process has the model")
layout = sizes(whole, 4)[0]

# The same in this process alone.
if rank == 0:
    image = vtkFiberPhantom()
    image.SetDimensions(64, 48, 48)
    image.SetSeed(4)
    alone = vtkFiberReconstruction()
    alone.SetInputConnection(image.GetOutputPort())
    alone.SetNumberOfQuads(60)
    alone.Update()
    one = alone.GetOutputDataObject(0)
    check_equal(model, (one.GetNumberOfPoints(), one.GetNumberOfCells()), "model")
    check_equal(layout[1], alone.GetOutputDataObject(4).GetNumberOfCells(), "quads")
    got = whole.GetClientSideObject().GetOutputDataObject(0)
    check((points(got) == points(one)).all(), "points are the same bit for bit")

# The chain by hand: images in pieces, surfaces in pieces with seams, one layout, one model.
middle = Median(Input=OutputPort(phantom, 0), KernelSize=[3, 3, 3])
check_equal(sizes(middle)[0][1], 63 * 47 * 47, "voxels of all pieces of the median")
closing = Closing(Input=OutputPort(phantom, 0))
total, here = sizes(closing)
check_equal(total[1], 63 * 47 * 47, "voxels of all pieces of the closing")
check(0 < here < total[0], "each process has a piece of the closing")
closed = Contour(Input=closing, ContourBy=["POINTS", "SignedDistance"], Isosurfaces=[0.0])
raw = Contour(Input=OutputPort(phantom, 0), ContourBy=["POINTS", "CT"],
              Isosurfaces=[field(closing.GetClientSideObject().GetOutputDataObject(0), "IsoValue")[0]])
walls = EDTClassify(Input=raw, ClosedImage=closing)
joined, here = sizes(walls)
check_equal(joined, sizes(whole, 5)[0], "points and triangles, once each")
check(joined[0] < sizes(raw)[0][0], "the pieces had points at their seam twice")
check(here == (joined[0] if rank == 0 else 0), "the first process has the walls")
ends = FiberEnds(Input=closed, RawSurface=walls)
quads = QuadRemesh(Input=OutputPort(ends, 0), NumberOfQuads=60)
parts = PartitionToQuads(Input=walls, Quads=OutputPort(quads, 0))
fit = BSplineG1Fit(Input=OutputPort(parts, 0), Quads=OutputPort(quads, 0))
check(sizes(fit)[0][1] > 0, "a model")
surface = quads.GetClientSideObject().GetOutputDataObject(0)
if rank == 0:
    check_equal(field(surface, "EulerCharacteristic")[0], 2, "Euler characteristic of the layout")
deviation = SplineDeviation(Input=raw, Model=OutputPort(fit, 0))
check_equal(sizes(deviation)[0], joined, "points with their distance")
coarse = SplineSample(Input=OutputPort(fit, 0), Resolution=1)
check(0 < sizes(coarse)[0][1] < sizes(fit)[0][1], "fewer polygons")

# All processes write; one file comes of it.
name = temp_file("mpi_pipeline.step")
if rank == 0 and os.path.exists(name):
    os.remove(name)
SaveData(name, proxy=OutputPort(fit, 0))
if rank == 0:
    faces = open(name).read().count("ADVANCED_FACE")
    patches = array(fit.GetClientSideObject().GetOutputDataObject(0), "SplinePatches", "field")
    check_equal(faces, len(patches), "faces in the file")
    print("two processes agree with one")
