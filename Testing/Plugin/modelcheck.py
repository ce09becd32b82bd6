"""Judges a spline model from its exact field arrays alone, independently of the code that made it.

    numbers = judge(polydata)        # see judge() for the keys
    d = distances(polydata, shell, points)
"""
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkStaticPointLocator, vtkPolyData
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.util.numpy_support import numpy_to_vtk

SIDE_CORNERS = ((0, 1), (1, 2), (3, 2), (0, 3))  # along the increasing parameter; 0=(0,0) 1=(1,0) 2=(1,1) 3=(0,1)


def _basis(knots, degree, count, t):
    """Values and derivatives (two arrays, len(t) x count) of the B-splines at t, by de Boor's recursion."""
    last = np.max(np.nonzero(np.diff(knots[:count + 1]) > 0)[0])
    span = np.minimum(np.searchsorted(knots[:count + 1], t, side="right") - 1, last)
    table = np.zeros((len(t), len(knots) - 1))
    table[np.arange(len(t)), span] = 1.0
    for d in range(1, degree + 1):
        below, n = table, len(knots) - 1 - d
        left, right = knots[d:d + n] - knots[:n], knots[d + 1:d + 1 + n] - knots[1:1 + n]
        inverse = [np.divide(1.0, w, out=np.zeros_like(w), where=w > 0) for w in (left, right)]
        table = (t[:, None] - knots[:n]) * inverse[0] * below[:, :n] \
            + (knots[d + 1:d + 1 + n] - t[:, None]) * inverse[1] * below[:, 1:n + 1]
    return table, degree * (below[:, :n] * inverse[0] - below[:, 1:n + 1] * inverse[1])


class ExactModel:
    def __init__(self, data):
        def get(name):
            return vtk_to_numpy(data.GetFieldData().GetArray(name))
        self.patches = get("SplinePatches").astype(int)
        self.points = get("SplineControlPoints")
        self.knots = get("SplineKnots").ravel()
        self.neighbors = get("SplineNeighbors").astype(int)
        self.shells = self.patches[:, 0]

    def net(self, p):
        _, _, _, nu, nv, first, _, _ = self.patches[p]
        return self.points[first:first + nu * nv].reshape(nv, nu, 4)

    def evaluate(self, p, u, v):
        """Points and derivatives on the grid u x v (parameters in 0..1 of the domain): arrays (len(v), len(u), 3)."""
        _, du, dv, nu, nv, _, ku, kv = self.patches[p]
        k, l = self.knots[ku:ku + nu + du + 1], self.knots[kv:kv + nv + dv + 1]
        a, a1 = _basis(k, du, nu, k[du] + u * (k[nu] - k[du]))
        b, b1 = _basis(l, dv, nv, l[dv] + v * (l[nv] - l[dv]))
        h = self.net(p).copy()
        h[..., :3] *= h[..., 3:]
        s, su, sv = (np.einsum("bj,ai,jik->bak", y, x, h) for x, y in ((a, b), (a1, b), (a, b1)))
        x = s[..., :3] / s[..., 3:]
        return x, (su[..., :3] - x * su[..., 3:]) / s[..., 3:], (sv[..., :3] - x * sv[..., 3:]) / s[..., 3:]

    def along(self, p, side, t):
        """The same along a side, as arrays (len(t), 3)."""
        end = np.array([1.0 if side in (1, 2) else 0.0])
        u, v = (t, end) if side in (0, 2) else (end, t)
        return [x.reshape(-1, 3) for x in self.evaluate(p, u, v)]

    def border(self, p, side):
        g = self.net(p)
        return (g[0], g[:, -1], g[-1], g[:, 0])[side]


def _unit(x):
    return x / np.maximum(np.linalg.norm(x, axis=-1, keepdims=True), 1e-300)


def _euler(m, shell):
    """Vertices - edges + faces of a shell's patch complex."""
    ids = np.flatnonzero(m.shells == shell)
    leader = {(p, c): (p, c) for p in ids for c in range(4)}

    def find(x):
        while leader[x] != x:
            x = leader[x]
        return x
    sides = 0.0
    for p in ids:
        for s in range(4):
            n = m.neighbors[p, s]
            if n < 0 or m.shells[n // 4] != shell:
                sides += 1
                continue
            sides += 0.5
            q, r = divmod(n, 4)
            here, there = m.border(p, s), m.border(q, r)
            ends = SIDE_CORNERS[r] if (here[0] == there[0]).all() else SIDE_CORNERS[r][::-1]
            for c, d in zip(SIDE_CORNERS[s], ends):
                leader[find((p, c))] = find((q, d))
    return len({find(x) for x in leader}) - int(sides) + len(ids)


def judge(data, samples=33):
    """Numbers of a model: shells {shell: patches}, borders {shell: open sides}, gap (world units), identical (share
    of shared sides with bit-identical control points), jump (largest angle in degrees between the normals of
    neighbors in a shell that is no wall), folded (patches), euler {shell: characteristic}, symmetric."""
    m = ExactModel(data)
    t = np.linspace(0, 1, samples)
    gap = jump = 0.0
    identical, borders, symmetric = [], {}, True
    for p in range(len(m.patches)):
        for s in range(4):
            n = m.neighbors[p, s]
            if n < 0:
                borders[int(m.shells[p])] = borders.get(int(m.shells[p]), 0) + 1
                continue
            q, r = divmod(n, 4)
            symmetric = symmetric and m.neighbors[q, r] == 4 * p + s
            if (q, r) < (p, s):
                continue
            a, b = m.border(p, s), m.border(q, r)
            turned = not (a[0] == b[0]).all() or (a[0] == a[-1]).all()
            identical.append(a.shape == b.shape and bool((a == (b[::-1] if turned else b)).all()))
            x, xu, xv = m.along(p, s, t)
            y, yu, yv = (z[::-1] if turned else z for z in m.along(q, r, t))
            gap = max(gap, float(np.linalg.norm(x - y, axis=1).max()))
            if m.shells[p] == m.shells[q] != 2:
                c = np.linalg.norm(np.cross(_unit(np.cross(xu, xv)), _unit(np.cross(yu, yv))), axis=1)
                d = np.einsum("ij,ij->i", np.cross(xu, xv), np.cross(yu, yv))
                jump = max(jump, float(np.degrees(np.where(d > 0, np.arcsin(np.minimum(c, 1)), np.pi)).max()))
    return dict(shells={int(s): int((m.shells == s).sum()) for s in np.unique(m.shells)}, borders=borders, gap=gap,
                identical=float(np.mean(identical)) if identical else 1.0, jump=jump, folded=_folded(m),
                euler={int(s): _euler(m, s) for s in np.unique(m.shells) if s != 2}, symmetric=symmetric)


def _folded(m):
    """Patches whose normal vanishes or turns by more than 90 degrees between neighboring samples of a 25 x 25 grid."""
    t, count = np.linspace(0, 1, 25), 0
    for p in range(len(m.patches)):
        _, xu, xv = m.evaluate(p, t, t)
        n = np.cross(xu, xv)
        size = np.linalg.norm(n, axis=2)
        turned = (np.einsum("...i,...i", n[1:], n[:-1]) < 0).any() or (np.einsum("...i,...i", n[:, 1:], n[:, :-1]) < 0).any()
        count += bool(turned or (size < 1e-6 * size.mean()).any())
    return count


def distances(data, shell, points):
    """Distance of each point to a shell, by the tangent plane of the nearest of 25 x 25 samples a patch."""
    m, t, xs, ns = ExactModel(data), np.linspace(0, 1, 25), [], []
    for p in np.flatnonzero(m.shells == shell):
        x, xu, xv = m.evaluate(p, t, t)
        xs.append(x.reshape(-1, 3))
        ns.append(_unit(np.cross(xu, xv)).reshape(-1, 3))
    xs, ns = np.concatenate(xs), np.concatenate(ns)
    cloud, store = vtkPolyData(), vtkPoints()
    store.SetData(numpy_to_vtk(xs, deep=True))
    cloud.SetPoints(store)
    locator = vtkStaticPointLocator()
    locator.SetDataSet(cloud)
    locator.BuildLocator()
    nearest = np.array([locator.FindClosestPoint(q) for q in points])
    offset = points - xs[nearest]
    far = np.linalg.norm(offset, axis=1)
    spacing = np.median(far) + 1e-300
    plane = np.abs(np.einsum("ij,ij->i", offset, ns[nearest]))
    return np.where(far < 6 * spacing, plane, far)
