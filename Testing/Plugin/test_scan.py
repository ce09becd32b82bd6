"""Scan To NURBS in ParaView: both layout methods, every optimizer; the states of the examples."""
from bsrtesting import *
from modelcheck import judge

body = Superquadric(ThetaRoundness=0.4, PhiRoundness=0.3, ThetaResolution=40, PhiResolution=40, Toroidal=0)
whole = Clean(Input=Triangulate(Input=body))
whole.UpdatePipeline()


def model_of(proxy, what, euler=2):
    """The model's report, everything asserted that must hold."""
    with Errors(proxy) as errors:
        model = fetch(proxy, 0)
    errors.check_none()
    numbers = judge(model)
    check_equal(numbers["euler"], {0: euler}, what + ": Euler characteristic")
    check_equal(numbers["folded"], 0, what + ": folded patches")
    check_equal(numbers["identical"], 1.0, what + ": shared control points")
    check(numbers["jump"] <= 0.01, "%s: normals jump by %g degrees" % (what, numbers["jump"]))
    check(numbers["gap"] < 1e-12, "%s: gap %g" % (what, numbers["gap"]))
    report = fetch(proxy, 2)
    check_equal(field(report, "FailedQuads")[0], 0, what + ": failed quads")
    print("%s: %d patches, RMS %.2e of the diagonal" % (what, report.GetNumberOfRows(), field(report, "RelativeRMS")[0]))
    return report


nurbs = ScanToNURBS(Input=whole, NumberOfQuads=24)
rms = {}
for optimizer in ("None", "Evolution Strategy", "Deterministic"):
    nurbs.Optimizer = optimizer
    report = model_of(nurbs, optimizer)
    rms[optimizer] = field(report, "RelativeRMS")[0]
    rows = dataset_adapter.WrapDataObject(report).RowData
    if optimizer != "None":
        check(rows["Mean"].mean() < rows["MeanBefore"].mean(), optimizer + ": the mean distance falls")
    if optimizer == "Deterministic":
        check(rows["LargestWeight"].max() > 1.01, "there are weights")
check(rms["Deterministic"] < rms["None"], "weights lower the error")
check(rms["Evolution Strategy"] < rms["None"], "the evolution strategy lowers the error")

nurbs.Optimizer = "None"
nurbs.Method = "Morse-Smale"
model_of(nurbs, "Morse-Smale")

for name in ("scan.pvsm", "morse_smale.pvsm"):
    ResetSession()
    load_plugin()
    LoadState(os.path.join(SOURCE_DIR, "Examples", name))
    kinds = {proxy.GetXMLName(): proxy for proxy in GetSources().values()}
    check("ScanToNURBS" in kinds, name + " holds the pipeline: %s" % sorted(kinds))
    model_of(kinds["ScanToNURBS"], name)
    if name.startswith("morse"):
        check_equal(kinds["ScanToNURBS"].Method, "Morse-Smale", name + ": method")
