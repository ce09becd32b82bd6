"""Quad Remesh, method Morse-Smale, in ParaView: properties, both ports, arrays, errors."""
from bsrtesting import *

source = Superquadric(ThetaResolution=100, PhiResolution=80, Toroidal=1, ThetaRoundness=1, PhiRoundness=1)
surface = Triangulate(Input=source)
surface.UpdatePipeline()
f = QuadRemesh(Input=surface, Method="Morse-Smale", NumberOfQuads=60)
check_equal(f.Eigenfunction, 0, "automatic eigenfunction")
with Errors(f) as errors:
    quads = fetch(f)
    cut = fetch(f, 1)
errors.check_none()
check(48 <= quads.GetNumberOfCells() <= 72, "about as many quads as asked for")
minima, saddles, maxima = (field(quads, name)[0] for name in ("Minima", "Saddles", "Maxima"))
check_equal(field(quads, "EulerCharacteristic")[0], 0, "Euler characteristic of a torus")
check_equal(minima - saddles + maxima, 0, "the Morse relation")
check_equal(field(quads, "MorseCells")[0], 2 * saddles, "cells")
check_equal(field(quads, "LayoutStage")[0], 2, "stage")
check_equal(sorted(set(array(cut, "Cell", "cell"))), list(range(int(2 * saddles))), "every cell has triangles")
critical = list(array(cut, "Critical"))
check_equal([critical.count(k) for k in (1, 2, 3)], [minima, saddles, maxima], "critical points are marked")
check_close(abs(array(cut, "Eigenfunction")).max(), 1, 0.01, "largest value of the function")

f.Eigenfunction = 40
with Errors(f) as errors:
    quads = fetch(f)
errors.check_none()
check_equal(field(quads, "EigenfunctionTaken")[0], 40, "eigenfunction of choice")

f.Eigenfunction = -1
with Errors(f) as errors:
    f.UpdatePipeline()
errors.check_one("Eigenfunction")
