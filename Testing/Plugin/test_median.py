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
