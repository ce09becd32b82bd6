"""FiberReconstruction inside ParaView: ports, arrays, invariants, sides, threads, bad input, abort."""
import subprocess

from bsrtesting import *
from fiberseeds import check_model
from modelcheck import ExactModel

QUADS = 150


def reconstruct(source, **settings):
    return FiberReconstruction(Input=source, NumberOfQuads=QUADS, **settings)


def bits(data):
    return b"".join(array(data, n, "field").tobytes() for n in ("SplinePatches", "SplineControlPoints", "SplineNeighbors"))


def ports_and_arrays(phantom):
    fiber = reconstruct(phantom)
    with Errors(fiber) as errors:
        model = fetch(fiber)
    errors.check_none()
    check_model(model, True, "open fiber")
    for name in ("PatchId", "Shell"):
        array(model, name, "cell")
    array(model, "UV")
    check(fetch(fiber, 1).GetNumberOfPoints() >= ExactModel(model).points.shape[0] // 2, "the control net has points")
    report = fetch(fiber, 2)
    check_equal(report.GetNumberOfRows(), len(ExactModel(model).patches), "rows of the report")
    for name in ("RMS", "Max", "MaxNormalJump", "FoldedPatches", "Seconds", "StageSeconds", "ClosingRadius", "IsoValue"):
        field(report, name)
    check_equal(field(report, "OpenEnds")[0], 2, "open ends")
    array(fetch(fiber, 3), "EndRegion", "cell")
    check(fetch(fiber, 4).GetNumberOfCells() > 50, "the layout has quads")
    raw = fetch(fiber, 5)
    for name in ("Depth", "Side", "QuadId", "UV", "QuadDistance"):
        array(raw, name)
    return bits(model)


def the_same_on_one_thread(expected):
    """Another process, bound to one processor: the same bits."""
    path = temp_file("one_thread.vtp")
    script = temp_file("one_thread.py")
    with open(script, "w") as out:
        out.write("from bsrtesting import *\n"
                  "f = FiberReconstruction(Input=FiberPhantom(Seed=2), NumberOfQuads=%d)\n"
                  "SaveData(%r, proxy=OutputPort(f, 0))\n" % (QUADS, path))
    subprocess.run(["taskset", "-c", "0", "pvpython", script], check=True)
    again = OpenDataFile(path)
    check(bits(fetch(again)) == expected, "one thread gives the same bits")


def one_side_alone(phantom):
    heights = {}
    for sides in ("Outer Only", "Inner Only"):
        m = ExactModel(fetch(reconstruct(phantom, Sides=sides)))
        check_equal(set(m.shells), {0}, "shells, " + sides)
        check((m.neighbors >= 0).all(), "closed, " + sides)
        heights[sides] = numpy.ptp(m.points[:, 2])
    check(heights["Inner Only"] < heights["Outer Only"], "the inner wall lies inside")


def bad_input():
    flat = Wavelet(WholeExtent=[0, 12, 0, 12, 0, 12], Maximum=0.0, XMag=0.0, YMag=0.0, ZMag=0.0)
    flat.UpdatePipeline()
    fiber = reconstruct(flat)
    with Errors(fiber) as errors:
        fiber.UpdatePipeline()
    errors.check_one("Closing")
    check_equal(fetch(fiber).GetNumberOfCells(), 0, "cells after an error")


def cancelled(phantom):
    """Cancelled at half of the work: no error, nothing in any output; the next run is whole."""
    fiber = reconstruct(phantom, Resolution=2)
    algorithm = fiber.GetClientSideObject()
    tag = algorithm.AddObserver("ProgressEvent", lambda caller, _: caller.GetProgress() > 0.5 and caller.SetAbortExecute(1))
    with Errors(fiber) as errors:
        fiber.UpdatePipeline()
    errors.check_none()
    for port in (0, 1, 3, 4, 5):
        check_equal(servermanager.Fetch(fiber, idx=port).GetNumberOfPoints(), 0, "points of port %d after a cancel" % port)
    algorithm.RemoveObserver(tag)
    algorithm.SetAbortExecute(0)
    fiber.Resolution = 3
    check(fetch(fiber).GetNumberOfCells() > 0, "the run after a cancelled one gives a model")


if __name__ == "__main__":
    fiber_phantom = FiberPhantom(Seed=2)
    fiber_phantom.UpdatePipeline()
    expected_bits = ports_and_arrays(fiber_phantom)
    one_side_alone(fiber_phantom)
    bad_input()
    cancelled(fiber_phantom)
    the_same_on_one_thread(expected_bits)
