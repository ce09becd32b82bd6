"""The proxy Median: VTK's filter in the plugin's menu, with the default box of 5 x 5 x 5."""
from bsrtesting import *

source = Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8])
source.UpdatePipeline()
f = Median(Input=source)
check_equal(list(f.KernelSize), [5, 5, 5], "default kernel")
check_equal(list(f.Scalars), ["POINTS", "RTData"], "default array")

before = array(fetch(source), "RTData").reshape(17, 17, 17)
after = array(fetch(f), "RTData").reshape(17, 17, 17)
expected = numpy.median(before[6:11, 6:11, 6:11])
check_close(after[8, 8, 8], expected, 1e-4, "median at the center")

f.KernelSize = [1, 1, 1]
same = array(fetch(f), "RTData").reshape(17, 17, 17)
check(numpy.array_equal(same, before), "a box of one voxel changes nothing")

# A source that has not run yet offers no array; the filter then takes the active scalars.
late = FiberPhantom(Dimensions=[48, 32, 32])
m = Median(Input=OutputPort(late, 0))
with Errors(m) as errors:
    check_equal(len(array(fetch(m), "CT")), 48 * 32 * 32, "voxels")
errors.check_none()
m.Scalars = ["POINTS", "Nothing"]
with Errors(m) as errors:
    m.UpdatePipeline()
errors.check_one("choose one under Scalars")
