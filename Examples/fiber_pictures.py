"""Pictures of every stage of the fiber pipeline, as in figure 6 of Mosbach et al.; used by fiber.py."""
from paraview import simple as pv
from paraview import servermanager as sm

import stage_views

SIZE = [1400, 900]
SURFACE = [0.86, 0.82, 0.74]
INNER = [0.55, 0.68, 0.82]
WALL = [0.93, 0.68, 0.38]


def aim(view, bounds):
    """Looks at the box so that its longest axis lies across the picture, from a little above."""
    size = [bounds[2 * i + 1] - bounds[2 * i] for i in range(3)]
    along = size.index(max(size))
    up = 2 if along != 2 else 1
    depth = 3 - along - up
    center = [0.5 * (bounds[2 * i] + bounds[2 * i + 1]) for i in range(3)]
    eye = list(center)
    eye[depth] -= 3 * max(size)
    eye[up] += 0.9 * max(size)
    eye[along] -= 0.9 * max(size)
    view.CameraFocalPoint = center
    view.CameraPosition = eye
    view.CameraViewUp = [1.0 if i == up else 0.0 for i in range(3)]
    view.CameraParallelProjection = 1
    view.ResetCamera()
    view.GetActiveCamera().Zoom(1.55)


def show(proxy, view, color=None, array=None, edges=False):
    display = stage_views.show(proxy, view, color or SURFACE, array, edges)
    display.Specular = 0.3
    return display


def picture(folder, name, bounds, paint):
    view = stage_views.new_view(SIZE)
    paint(view)
    aim(view, bounds)
    stage_views.save(view, folder, name)


def shell(model, number):
    """The polygons of one shell of a model (0 outer, 1 inner, 2 wall)."""
    t = pv.Threshold(Input=model, Scalars=["CELLS", "Shell"], LowerThreshold=number, UpperThreshold=number)
    return t


def cut_open(model, bounds):
    """The model without the half that faces the viewer."""
    size = [bounds[2 * i + 1] - bounds[2 * i] for i in range(3)]
    along = size.index(max(size))
    depth = 3 - along - (2 if along != 2 else 1)
    clip = pv.Clip(Input=model, ClipType="Plane")
    clip.ClipType.Origin = [0.5 * (bounds[2 * i] + bounds[2 * i + 1]) for i in range(3)]
    clip.ClipType.Normal = [-1.0 if i == depth else 0.0 for i in range(3)]
    clip.Invert = 1
    return clip


def shells_with_colors(proxy, view):
    for number, color in ((0, SURFACE), (1, INNER), (2, WALL)):
        part = shell(proxy, number)
        part.UpdatePipeline()
        if part.GetDataInformation().GetNumberOfCells():
            show(part, view, color)


def deviation(fiber, folder, bounds):
    """The raw points' distances to the model: a map with its scale and a histogram beside it."""
    wanted = pv.Threshold(Input=pv.OutputPort(fiber, 5), Scalars=["POINTS", "Side"], LowerThreshold=0, UpperThreshold=1)
    surface = pv.ExtractSurface(Input=wanted)
    measured = pv.SplineDeviation(Input=surface, Model=pv.OutputPort(fiber, 0))
    measured.UpdatePipeline()
    if measured.GetDataInformation().GetNumberOfPoints() == 0:
        return
    data = sm.Fetch(measured)
    limit = 3.0 * data.GetFieldData().GetArray("RMS").GetTuple1(0) or 1.0
    view = stage_views.new_view(SIZE)
    display = show(measured, view, array=("POINTS", "Deviation"))
    lut = pv.GetColorTransferFunction("Deviation")
    lut.ApplyPreset("Cool to Warm (Extended)", True)
    lut.RescaleTransferFunction(-limit, limit)
    display.SetScalarBarVisibility(view, True)
    bar = pv.GetScalarBar(lut, view)
    bar.Title, bar.ComponentTitle = "Deviation (world units)", ""
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    aim(view, bounds)
    stage_views.save(view, folder, "7_deviation_map")
    histogram = pv.Histogram(Input=measured, SelectInputArray=["POINTS", "Deviation"], BinCount=80,
                             UseCustomBinRanges=1, CustomBinRanges=[-limit, limit])
    chart = pv.CreateView("XYBarChartView")
    chart.ViewSize = SIZE
    chart.ChartTitle = "Deviation of the raw points from the model (world units)"
    chart.LeftAxisTitle, chart.ShowLegend = "points", 0
    bars = pv.Show(histogram, chart)
    bars.XArrayName = "bin_extents"
    bars.SeriesVisibility = ["bin_values"]
    stage_views.save(chart, folder, "8_deviation_histogram")


def save_all(volume, fiber, folder):
    """Writes 1_raw.png to 8_deviation_histogram.png into the folder."""
    model, closed, layout, raw = (pv.OutputPort(fiber, i) for i in (0, 3, 4, 5))
    bounds = raw.GetDataInformation().GetBounds()
    picture(folder, "1_raw", bounds, lambda v: show(raw, v))
    picture(folder, "2_closed", bounds, lambda v: show(closed, v))
    picture(folder, "3_layout", bounds, lambda v: show(layout, v, edges=True))
    picture(folder, "4_partition", bounds, lambda v: show(raw, v, array=("POINTS", "QuadId")))
    picture(folder, "4_sides", bounds, lambda v: show(raw, v, array=("POINTS", "Side")))
    picture(folder, "5_shells", bounds, lambda v: shells_with_colors(model, v))
    half = cut_open(model, bounds)
    picture(folder, "6_cut_open", bounds, lambda v: shells_with_colors(half, v))
    deviation(fiber, folder, bounds)
