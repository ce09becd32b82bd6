"""How closely the fiber pipeline follows the rims of open ends, and how its quads lie; not a test.

    BSR_PLUGIN=.../BSplineReconstruction.so pvpython Testing/Plugin/fiberrims.py 300,500 VOLUME.vti TRUTH.json ...

A line of Markdown a volume, number of quads and end: sides of quads around the end; distances in voxels, both ways
between two closed curves, root mean square / 95th percentile / largest: from the region border on the closed surface to
the layout's straight rim and back, to the outer rim of the model (the sides that outer patches share with walls) and back.
The last line of a volume is about the tube's quads: the mean angle between their middle lines and the fiber's axis or,
whichever is nearer, the direction around it. TRUTH.json holds the center line ("centerline").
"""
import json
import os
import sys

import numpy as np
from paraview import servermanager as sm
from paraview import simple as pv
from vtkmodules.util.numpy_support import vtk_to_numpy


def cells_of(data):
    """Points, and the polygons as lists of point numbers."""
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    polys = data.GetPolys()
    offsets = vtk_to_numpy(polys.GetOffsetsArray())
    ids = vtk_to_numpy(polys.GetConnectivityArray())
    return points, [ids[offsets[i]:offsets[i + 1]] for i in range(len(offsets) - 1)]


def borders(points, cells, value, first, second):
    """Edges, as pairs of points, between cells of one value and cells of another; None: any other than the first."""
    seen = {}
    found = []
    # Corners that coincide are one: the model's patches may have points of their own.
    _, same = np.unique(np.round(points, 6), axis=0, return_inverse=True)
    for cell, v in zip(cells, value):
        c = same.reshape(-1)[cell]
        for a, b, i, j in zip(c, np.roll(c, -1), cell, np.roll(cell, -1)):
            other = seen.setdefault((min(a, b), max(a, b)), v)
            if other != v and first in (other, v) and (second is None or second in (other, v)):
                found.append((points[i], points[j]))
    return np.array(found)


def sampled(edges, step):
    """Points along edges, at most a step apart."""
    out = []
    for a, b in edges:
        n = max(1, int(np.ceil(np.linalg.norm(b - a) / step)))
        out.extend(a + (b - a) * (k + 0.5) / n for k in range(n))
    return np.array(out)


def distances(points, edges):
    """From points to the nearest edge."""
    a, d = edges[:, 0], edges[:, 1] - edges[:, 0]
    length = np.maximum((d * d).sum(1), 1e-30)
    out = np.empty(len(points))
    for i, p in enumerate(points):
        t = np.clip(((p - a) * d).sum(1) / length, 0.0, 1.0)
        out[i] = np.sqrt((((a + t[:, None] * d) - p) ** 2).sum(1).min())
    return out


def figures(one, other, voxel):
    """Both ways."""
    text = []
    for a, b in ((one, other), (other, one)):
        d = distances(sampled(a, 0.3 * voxel), b) / voxel
        text.append("%.2f / %.2f / %.2f" % (np.sqrt((d ** 2).mean()), np.percentile(d, 95), d.max()))
    return " | ".join(text)


def split(edges, centers):
    """The edges nearest to each of the centers."""
    middle = edges.mean(1)
    near = np.array([np.linalg.norm(middle - c, axis=1) for c in centers]).argmin(0)
    return [edges[near == k] for k in range(len(centers))]


def turned(points, cells, region, centerline):
    """Mean angle of the tube's quads against the axis and around, in degrees; of those away from the ends, too."""
    line = np.array(centerline)
    tangent = np.gradient(line, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    angles = []
    for cell, r in zip(cells, region):
        if r != 0 or len(cell) != 4:
            continue
        p = points[cell]
        at = np.linalg.norm(line - p.mean(0), axis=1).argmin()
        u, v = p[1] + p[2] - p[0] - p[3], p[2] + p[3] - p[0] - p[1]
        n = np.cross(u, v)
        around = np.cross(n, tangent[at])
        for d in (u, v):
            c = abs(np.dot(d, around)) / (np.linalg.norm(d) * np.linalg.norm(around))
            a = np.degrees(np.arccos(min(1.0, c)))
            angles.append(min(a, 90.0 - a))
    return float(np.mean(angles)), float(np.percentile(angles, 90))


def measure(volume, truth, quads):
    with open(truth, encoding="utf-8") as f:
        walls = json.load(f)
    voxel = min(walls["spacing"]) if isinstance(walls["spacing"], list) else walls["spacing"]
    image = pv.OpenDataFile(volume)
    name = os.path.basename(volume).split(".")[0]
    for asked in quads:
        image.UpdatePipeline()
        pv.SetActiveSource(image)
        fiber = FiberReconstruction(Input=image, NumberOfQuads=asked)
        fiber.UpdatePipeline()
        closed, layout, model = (sm.Fetch(fiber, idx=k) for k in (3, 4, 0))
        points, cells = cells_of(closed)
        on_surface = vtk_to_numpy(closed.GetCellData().GetArray("EndRegion"))
        lpoints, lcells = cells_of(layout)
        on_layout = vtk_to_numpy(layout.GetCellData().GetArray("EndRegion"))
        mpoints, mcells = cells_of(model)
        shell = vtk_to_numpy(model.GetCellData().GetArray("Shell"))
        ends = sorted(set(on_surface) - {0})
        border = [borders(points, cells, on_surface, e, None) for e in ends]
        rims = [borders(lpoints, lcells, on_layout, e, None) for e in ends]
        centers = [b.mean((0, 1)) for b in border]
        wall = borders(mpoints, mcells, shell, 0, 2)
        outer = split(wall, centers) if len(wall) else [[] for _ in ends]
        for e, b, r, m in zip(ends, border, rims, outer):
            print("| %s | %d | %d | %d | %s | %s |" % (
                name, asked, e, len(r), figures(b, r, voxel) if len(r) else "closed | ",
                figures(b, m, voxel) if len(m) else "closed | "), flush=True)
        print("| %s | %d | quads of the tube off axis: mean, 90 %% | %.1f°, %.1f° |" % (
            (name, asked) + turned(lpoints, lcells, on_layout, walls["centerline"])), flush=True)


if __name__ == "__main__":
    pv.LoadPlugin(os.environ["BSR_PLUGIN"], remote=False, ns=globals())
    for i in range(2, len(sys.argv) - 1, 2):
        measure(sys.argv[i], sys.argv[i + 1], [int(n) for n in sys.argv[1].split(",")])
