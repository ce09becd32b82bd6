"""From a CT volume of a hollow fiber to a B-spline solid in a STEP file.

    pvpython Examples/fiber.py [VOLUME [ISO]] [--output out] [--quads 300] [--plugin FILE]

VOLUME is any image that ParaView reads (.vti, .mhd, .nrrd, .tif ...); without it a digital fiber is made.
ISO is the gray value of the surface; without it the histogram decides. Writes model.vtp, model.step, report.csv
and a picture of every stage into the output folder, and prints a summary.
"""
import argparse
import os
import sys
import time

from paraview import simple as pv
from paraview import servermanager as sm

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import fiber_pictures as pictures  # noqa: E402
from stage_views import BUILT_PLUGIN, field, print_fit, print_times  # noqa: E402

PORTS = ("model", "control net", "report", "closed surface", "layout", "raw surface")


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("volume", nargs="?")
    p.add_argument("iso", nargs="?", type=float)
    p.add_argument("--output", default="out", help="folder for the results")
    p.add_argument("--quads", type=int, default=300, help="number of quads of the layout")
    p.add_argument("--plugin", default=BUILT_PLUGIN, help="BSplineReconstruction.so, if ParaView does not load it by itself")
    return p.parse_args()


def fail(message):
    print("fiber.py: " + message, file=sys.stderr)
    sys.exit(1)


def load_volume(a):
    """The volume as a pipeline source, from the file or made."""
    if a.volume is None:
        print("no volume given: making a digital fiber (FiberPhantom)")
        source = pv.FiberPhantom()
    else:
        if not os.path.exists(a.volume):
            fail("there is no file " + a.volume)
        source = pv.OpenDataFile(a.volume)
        if source is None:
            fail("ParaView has no reader for " + a.volume)
    source.UpdatePipeline()
    return source


def show_progress(proxy):
    """Prints the progress of a filter on one line of the terminal."""
    algorithm = proxy.GetClientSideObject()
    if algorithm is None or not sys.stderr.isatty():
        return
    started = time.time()

    def report(caller, _event):
        print("\r  %3.0f %%  %5.1f s" % (100 * caller.GetProgress(), time.time() - started), end="", file=sys.stderr)
    algorithm.AddObserver("ProgressEvent", report)


def reconstruct(a, volume):
    """Runs the compound filter; returns it once its model is there."""
    fiber = pv.FiberReconstruction(Input=volume, NumberOfQuads=a.quads)
    if a.iso is not None:
        fiber.AutoIsoValue = 0
        fiber.IsoValue = a.iso
    show_progress(fiber)
    fiber.UpdatePipeline()
    print(file=sys.stderr)
    if pv.OutputPort(fiber, 0).GetDataInformation().GetNumberOfCells() == 0:
        fail("no model was made; the error above says why")
    return fiber


def write_files(a, fiber):
    """Saves the model as .vtp and .step and the report as .csv; returns their paths."""
    paths = [os.path.join(a.output, n) for n in ("model.vtp", "model.step", "report.csv")]
    pv.SaveData(paths[0], proxy=pv.OutputPort(fiber, 0))
    pv.SaveData(paths[1], proxy=pv.OutputPort(fiber, 0))
    pv.SaveData(paths[2], proxy=pv.OutputPort(fiber, 2))
    return paths


def summary(fiber, paths, seconds):
    model, report = sm.Fetch(fiber, idx=0), sm.Fetch(fiber, idx=2)
    patches = field(model, "SplinePatches").reshape(-1, 8)[:, 0]
    print_times(report, seconds)
    print("iso value            %g" % field(report, "IsoValue")[0])
    print("closing radius       %.1f voxels" % field(report, "ClosingRadius")[0])
    print("open ends            %d" % (field(report, "OpenEnds")[0] if field(report, "OpenEnds") is not None else 0))
    print("patches              %d outer, %d inner, %d wall" % tuple((patches == s).sum() for s in range(3)))
    print("RMS to the points    %.4g (world units)" % field(report, "RMS")[0])
    print_fit(report, paths)


def main():
    a = arguments()
    os.makedirs(a.output, exist_ok=True)
    if not hasattr(pv, "FiberReconstruction"):
        pv.LoadPlugin(os.path.abspath(a.plugin), remote=False, ns=vars(pv))
    started = time.time()
    volume = load_volume(a)
    fiber = reconstruct(a, volume)
    paths = write_files(a, fiber)
    seconds = time.time() - started
    pictures.save_all(volume, fiber, a.output)
    summary(fiber, paths, seconds)


if __name__ == "__main__":
    main()
