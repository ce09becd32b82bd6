"""Runs FiberReconstruction on phantoms of several seeds and checks each model; shared by the test_fiber_seeds_*.py."""
from bsrtesting import *
from modelcheck import distances, judge


def check_model(data, open_ends, what):
    """Asserts every invariant of a fiber's model and returns its numbers."""
    n = judge(data)
    print(what, n)
    check_equal(n["symmetric"], True, what + ": neighbors symmetric")
    # The control points are the same bits; what is left is the rounding of sums taken in another order.
    check_between(n["gap"], 0.0, 1e-10, what + ": gap")
    check_equal(n["identical"], 1.0, what + ": share of bit-identical sides")
    check_between(n["jump"], 0.0, 0.01, what + ": normal jump in degrees")
    check_equal(n["folded"], 0, what + ": folded patches")
    check_equal(n["borders"], {}, what + ": open sides")
    characteristic = 0 if open_ends else 2
    check_equal(n["euler"], {0: characteristic, 1: characteristic}, what + ": Euler characteristic of the shells")
    check_equal(2 in n["shells"], bool(open_ends), what + ": walls")
    return n


def run_seed(seed, **settings):
    """One phantom through the pipeline; even seeds have open ends. Returns the RMS to the true walls in voxels."""
    open_ends = seed % 2 == 0
    phantom = FiberPhantom(Seed=seed, OpenEnds=int(open_ends), **settings)
    truth = fetch(phantom, 1)
    image = fetch(phantom, 0)
    fiber = FiberReconstruction(Input=OutputPort(phantom, 0), NumberOfQuads=300)
    with Errors(fiber) as errors:
        fiber.UpdatePipeline()
    errors.check_none()
    model = fetch(fiber)
    check_model(model, open_ends, "seed %d" % seed)
    side, where = array(truth, "Side"), points(truth)
    end = array(truth, "End") if truth.GetPointData().HasArray("End") else 0 * side
    rms = []
    for shell in (0, 1):
        d = distances(model, shell, where[(side == shell) & (end == 0)]) / min(image.GetSpacing())
        rms.append(float((d ** 2).mean() ** 0.5))
    print("seed %d: RMS to the true walls, outer and inner, in voxels: %.3f %.3f" % (seed, rms[0], rms[1]))
    Delete(fiber)
    Delete(phantom)
    return max(rms)


def run_seeds(seeds, mean_rms):
    rms = [run_seed(s) for s in seeds]
    mean = sum(rms) / len(rms)
    print("mean of the worse shell's RMS: %.3f voxels" % mean)
    check_between(mean, 0.0, mean_rms, "mean RMS in voxels")
