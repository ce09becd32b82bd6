"""Quad layouts of surfaces, with a table of what came of them.

    pvpython Examples/quadremesh.py SURFACE.vtp ... [--quads 50,250,500] [--output out] [--plugin FILE]

SURFACE is anything with polygons that ParaView reads (.vtp, .stl, .ply, .obj ...). Writes NAME-QUADS.vtp for each
surface and number of quads into the output folder and prints a table in Markdown: quads, validity, topology, irregular
vertices, shape, distance in percent of the bounding box's diagonal, repairs, seconds by stage.
"""
import argparse
import os

from paraview import simple as pv
from paraview import servermanager as sm

BUILT_PLUGIN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "lib",
                            "BSplineReconstruction", "BSplineReconstruction.so")
COLUMNS = ("surface", "triangles", "asked", "quads", "least", "χ", "loops", "irregular", "valences 3 5 6 7 8 9+",
           "scaled Jacobian min / mean", "flipped", "angle mean / max", "Hausdorff / mean %", "repairs",
           "repair + decimation + layout + measure s")


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("surfaces", nargs="+")
    p.add_argument("--quads", default="250,500", help="numbers of quads, separated by commas")
    p.add_argument("--output", default="out")
    p.add_argument("--plugin", default=BUILT_PLUGIN)
    return p.parse_args()


def numbers(data, name):
    """The components of a field array."""
    a = data.GetFieldData().GetArray(name)
    return [a.GetComponent(0, i) for i in range(a.GetNumberOfComponents())]


def repairs(data):
    a = data.GetFieldData().GetArray("Repairs")
    found = [f"{a.GetComponentName(i)} {a.GetComponent(0, i):.0f}" for i in range(a.GetNumberOfComponents())
             if a.GetComponent(0, i) > 0]
    return ", ".join(found) or "none"


def diagonal(bounds):
    return sum((bounds[2 * i + 1] - bounds[2 * i]) ** 2 for i in range(3)) ** 0.5


def row(name, surface, layout, asked):
    """One line of the table."""
    data = sm.Fetch(layout)
    one = {n: numbers(data, n)[0] for n in (
        "MinimumQuads", "EulerCharacteristic", "BoundaryLoops", "Irregular", "MinScaledJacobian", "MeanScaledJacobian",
        "FlippedQuads", "MeanAngleDeviation", "MaxAngleDeviation", "Hausdorff", "MeanDistance")}
    valences = numbers(data, "ValenceCounts")
    percent = 100.0 / diagonal(surface.GetDataInformation().GetBounds())
    return (name, surface.GetDataInformation().GetNumberOfCells(), asked, data.GetNumberOfCells(),
            f"{one['MinimumQuads']:.0f}", f"{one['EulerCharacteristic']:.0f}", f"{one['BoundaryLoops']:.0f}",
            f"{one['Irregular']:.0f}", " ".join(f"{valences[k]:.0f}" for k in (3, 5, 6, 7, 8, 9)),
            f"{one['MinScaledJacobian']:.2f} / {one['MeanScaledJacobian']:.2f}", f"{one['FlippedQuads']:.0f}",
            f"{one['MeanAngleDeviation']:.1f} / {one['MaxAngleDeviation']:.0f}",
            f"{percent * one['Hausdorff']:.2f} / {percent * one['MeanDistance']:.2f}", repairs(data),
            " + ".join(f"{s:.2f}" for s in numbers(data, "StageSeconds")))


def print_row(cells):
    print("| " + " | ".join(str(c) for c in cells) + " |", flush=True)


def main():
    a = arguments()
    pv.LoadPlugin(a.plugin, remote=False, ns=globals())
    os.makedirs(a.output, exist_ok=True)
    print_row(COLUMNS)
    print_row(["---"] * len(COLUMNS))
    for path in a.surfaces:
        name = os.path.splitext(os.path.basename(path))[0]
        surface = pv.OpenDataFile(path)
        surface.UpdatePipeline()
        layout = QuadRemesh(Input=surface)  # noqa: F821 (comes with the plugin)
        for asked in (int(n) for n in a.quads.split(",")):
            layout.NumberOfQuads = asked
            layout.UpdatePipeline()
            if layout.GetDataInformation().GetNumberOfCells() == 0:
                print_row((name, "", asked, "failed, see above") + ("",) * (len(COLUMNS) - 4))
                continue
            print_row(row(name, surface, layout, asked))
            pv.SaveData(os.path.join(a.output, f"{name}-{asked}.vtp"), proxy=pv.OutputPort(layout, 0))


if __name__ == "__main__":
    main()
