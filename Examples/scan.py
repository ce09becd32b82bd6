"""From a triangulated scan, or its points, to a network of NURBS patches in a STEP file.

    pvpython Examples/scan.py [SCAN] [--quads 300] [--output out] [--method field|morse]
                              [--optimizer none|evolution|deterministic] [--hole 0.25] [--tolerance 0] [--plugin FILE]

SCAN is any surface or set of points that ParaView reads (.vtp, .ply, .stl, .obj ...); without it a digital scan with a
gap is made. Writes model.vtp, model.step, report.csv, scan.pvsm and a picture of every stage into the output folder, and
prints a summary. Of points without triangles the surface is reconstructed first, inside the filter: normals by principal
components, a signed distance, its zero set (SurfaceFromPoints).
"""
import argparse
import os
import sys
import time

from paraview import simple as pv
from paraview import servermanager as sm

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stage_views import BUILT_PLUGIN, field, new_view, print_fit, print_times, save, show  # noqa: E402

METHODS = {"field": 0, "morse": 1}
OPTIMIZERS = {"none": 0, "evolution": 1, "deterministic": 2}
MODEL, REPORT, MESH, LAYOUT, POINTS, NETWORK = 0, 2, 3, 4, 5, 6
GRAY, BLACK, BLUE = [0.80, 0.80, 0.78], [0.1, 0.1, 0.1], [0.72, 0.78, 0.86]


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("scan", nargs="?")
    p.add_argument("--output", default="out", help="folder for the results")
    p.add_argument("--quads", type=int, default=300, help="number of quads of the layout")
    p.add_argument("--method", choices=METHODS, default="field", help="how the layout is found")
    p.add_argument("--optimizer", choices=OPTIMIZERS, default="none", help="how weights are found")
    p.add_argument("--hole", type=float, default=0.25, help="largest hole that is filled, of the diagonal")
    p.add_argument("--tolerance", type=float, default=0.0, help="mean distance of a patch, of the diagonal")
    p.add_argument("--plugin", default=BUILT_PLUGIN, help="BSplineReconstruction.so, if not loaded by itself")
    return p.parse_args()


def fail(message):
    print("scan.py: " + message, file=sys.stderr)
    sys.exit(1)


def load_scan(path):
    """The scan as a pipeline source, from the file or made: a superquadric with a gap."""
    if path is None:
        print("no scan given: making a digital one")
        body = pv.Superquadric(ThetaRoundness=0.7, PhiRoundness=0.6, ThetaResolution=80, PhiResolution=80, Toroidal=0)
        whole = pv.Clean(Input=pv.Triangulate(Input=body))
        gap = pv.Clip(Input=whole, ClipType="Sphere", Invert=0)
        gap.ClipType.Center, gap.ClipType.Radius = [0.45, 0.1, 0.1], 0.16
        source = pv.ExtractSurface(Input=gap)
    else:
        if not os.path.exists(path):
            fail("there is no file " + path)
        source = pv.OpenDataFile(path)
        if source is None:
            fail("ParaView has no reader for " + path)
    source.UpdatePipeline()
    return source


def reconstruct(a, scan):
    nurbs = pv.ScanToNURBS(Input=scan, NumberOfQuads=a.quads, Method=METHODS[a.method], MaximumHoleSize=a.hole,
                           Optimizer=OPTIMIZERS[a.optimizer], Tolerance=a.tolerance)
    nurbs.UpdatePipeline()
    if pv.OutputPort(nurbs, MODEL).GetDataInformation().GetNumberOfCells() == 0:
        fail("no model was made; the error above says why")
    return nurbs


def write_files(a, nurbs):
    paths = [os.path.join(a.output, n) for n in ("model.vtp", "model.step", "report.csv", "scan.pvsm")]
    pv.SaveData(paths[0], proxy=pv.OutputPort(nurbs, MODEL))
    pv.SaveData(paths[1], proxy=pv.OutputPort(nurbs, MODEL))
    pv.SaveData(paths[2], proxy=pv.OutputPort(nurbs, REPORT))
    pv.SaveState(paths[3])
    return paths


def picture(a, name, scan, paint):
    view = new_view([900, 900])
    paint(view)
    b = scan.GetDataInformation().GetBounds()
    size = max(b[1] - b[0], b[3] - b[2], b[5] - b[4])
    view.CameraFocalPoint = [0.5 * (b[2 * i] + b[2 * i + 1]) for i in range(3)]
    view.CameraPosition = [c + 3.0 * size * d for c, d in zip(view.CameraFocalPoint, (0.35, 0.3, 1.0))]
    view.CameraViewUp = [0.0, 1.0, 0.0]
    view.CameraParallelProjection = 1
    view.ResetCamera()
    view.GetActiveCamera().Zoom(1.4)
    save(view, a.output, name)


def pictures(a, scan, nurbs):
    """The stages, as in figure 1 of Branch et al."""
    port = lambda n: pv.OutputPort(nurbs, n)
    diagonal = scan.GetDataInformation().GetBounds()
    radius = 0.0015 * max(diagonal[1] - diagonal[0], diagonal[3] - diagonal[2], diagonal[5] - diagonal[4])

    def network(view):
        show(port(MESH), view, GRAY)
        show(pv.Tube(Input=port(NETWORK), Radius=radius * 1.5), view, BLACK)

    picture(a, "1_scan", scan, lambda v: show(scan, v, GRAY, edges=True))
    picture(a, "2_closed", scan, lambda v: show(port(MESH), v, GRAY, array=("CELLS", "Filled")))
    picture(a, "3_layout", scan, lambda v: show(port(LAYOUT), v, GRAY, edges=True))
    picture(a, "4_network", scan, network)
    picture(a, "5_patches", scan, lambda v: show(port(MODEL), v, GRAY, array=("CELLS", "PatchId")))
    picture(a, "6_model", scan, lambda v: show(port(MODEL), v, BLUE))


def summary(nurbs, paths, seconds):
    report = sm.Fetch(nurbs, idx=REPORT)
    print_times(report, seconds)
    print("holes                %d filled, %d left" % (field(report, "FilledHoles")[0], field(report, "LeftHoles")[0]))
    print("Euler characteristic %d" % field(report, "EulerCharacteristic")[0])
    print("patches              %d" % report.GetNumberOfRows())
    print("RMS                  %.3g of the diagonal" % field(report, "RelativeRMS")[0])
    print("largest distance     %.3g of the diagonal" % field(report, "RelativeMax")[0])
    print_fit(report, paths)


def main():
    a = arguments()
    os.makedirs(a.output, exist_ok=True)
    if not hasattr(pv, "ScanToNURBS"):
        pv.LoadPlugin(os.path.abspath(a.plugin), remote=False, ns=vars(pv))
    started = time.time()
    scan = load_scan(a.scan)
    nurbs = reconstruct(a, scan)
    paths = write_files(a, nurbs)
    seconds = time.time() - started
    pictures(a, scan, nurbs)
    summary(nurbs, paths, seconds)


if __name__ == "__main__":
    main()
