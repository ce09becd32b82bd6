"""Fiber Phantom inside ParaView: properties, both ports, errors, and a picture."""
from bsrtesting import *

f = FiberPhantom(Dimensions=[128, 64, 64], Seed=3)
image = fetch(f, 0)
walls = fetch(f, 1)

check_equal(image.GetDimensions(), (128, 64, 64), "dimensions")
ct = array(image, "CT")
check_equal(ct.dtype, numpy.dtype("uint16"), "type of CT")
iso = field(image, "IsoValue")[0]
check_equal(iso, 19500.0, "iso value")
# Air and wall each fill enough of the image to be seen as two humps around their gray values.
check_close(numpy.median(ct[ct < iso]), 9000, 600, "gray value of air")
check_between(numpy.median(ct[ct > iso]), 23000, 30000, "gray value of the wall")

side = array(walls, "Side")
check_equal(sorted(set(side)), [0, 1], "sides")
check_equal(sorted(set(array(walls, "End"))), [0, 1, 2], "ends")
p = points(walls)
check(p.min() > 0 and (p.max(axis=0) < [127, 63, 63]).all(), "the walls lie in the volume")

# Most true points are on the isosurface: its nearest point is within two voxels.
probe = ResampleWithDataset(SourceDataArrays=OutputPort(f, 0), DestinationMesh=OutputPort(f, 1))
gray = array(fetch(probe), "CT")
check_between(numpy.mean(abs(gray - iso) < 7000), 0.7, 1.0, "share of true points near the iso value")

f.OpenEnds = 0
check_equal(set(array(fetch(f, 1), "End")), {0}, "ends of a closed fiber")
f.OpenEnds = 1

with Errors(f) as errors:
    f.Dimensions = [128, 10, 64]
    f.UpdatePipeline()
errors.check_one("Dimensions is 10; choose 24 to 8192 voxels a side.")
with Errors(f) as errors:
    f.Dimensions = [128, 64, 64]
    f.UpdatePipeline()
errors.check_none()

view = make_view()
surface = Contour(Input=OutputPort(f, 0), ContourBy=["POINTS", "CT"], Isosurfaces=[iso])
ColorBy(Show(surface, view), None)
view.CameraPosition = [64, -200, 100]
view.CameraFocalPoint = [64, 32, 32]
view.CameraViewUp = [0, 0, 1]
view.CameraParallelProjection = 1
view.CameraParallelScale = 48
check_picture(view, "FiberPhantom")
