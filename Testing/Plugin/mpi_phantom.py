"""Two processes: each makes its part of the image, and together they are the image of one."""
from bsplinereconstruction import vtkFiberPhantom  # before the first object of the plugin
from bsrtesting import *
from paraview.modules.vtkRemotingCore import vtkProcessModule
from vtkmodules.vtkParallelCore import vtkMultiProcessController

rank = vtkProcessModule.GetProcessModule().GetPartitionId()
controller = vtkMultiProcessController.GetGlobalController()
check_equal(controller.GetNumberOfProcesses(), 2, "number of processes")

f = FiberPhantom(Dimensions=[96, 48, 48], Seed=4)
f.UpdatePipeline()
part = f.GetClientSideObject().GetOutputDataObject(0)
check(0 < part.GetNumberOfPoints() < 96 * 48 * 48, "each process has a part of the image")

# The sum over cells does not count the points that both processes have.
cells = PointDatatoCellData(Input=OutputPort(f, 0))
total = IntegrateVariables(Input=cells)
total.UpdatePipeline()
walls = OutputPort(f, 1)
walls_there = walls.GetDataInformation().GetNumberOfPoints()
volume = total.CellData["Volume"].GetRange()[0]
mean = total.CellData["CT"].GetRange()[0] / volume

if rank == 0:
    check_equal(volume, 95 * 47 * 47, "volume of all pieces")
    one = vtkFiberPhantom()
    one.SetDimensions(96, 48, 48)
    one.SetSeed(4)
    one.Update()
    ct = array(one.GetOutputDataObject(0), "CT").reshape(48, 48, 96).astype(float)
    for axis in range(3):
        low = [slice(None)] * 3
        high = [slice(None)] * 3
        low[axis] = slice(None, -1)
        high[axis] = slice(1, None)
        ct = 0.5 * (ct[tuple(low)] + ct[tuple(high)])
    check_close(mean, ct.mean(), 1e-6 * ct.mean(), "mean gray value")
    check_equal(walls_there, one.GetOutputDataObject(1).GetNumberOfPoints(), "true points")
    print("two processes agree with one")
