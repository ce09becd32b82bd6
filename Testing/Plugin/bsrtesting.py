"""Helpers for the tests of the plugin; each test_*.py is a plain script that asserts.

    from bsrtesting import *          # loads the plugin into paraview.simple
    f = Median(Input=Wavelet())
    image = fetch(f)
    check_close(array(image, "RTData").max(), 276.8, 0.1, "maximum")
    check_picture(view, "MedianOfWavelet")
"""
import os
import sys
import tempfile

import numpy

from paraview import servermanager
from paraview.modules.vtkRemotingMisc import vtkSMTesting
from paraview.simple import *
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import vtk_to_numpy

SOURCE_DIR = os.environ["BSR_SOURCE_DIR"]
PLUGIN = os.environ["BSR_PLUGIN"]
TEMP_DIR = os.environ.get("BSR_TEMP_DIR") or tempfile.gettempdir()
os.makedirs(TEMP_DIR, exist_ok=True)
SKIPPED = 77


def skip(reason):
    """Ends the script; ctest shows it as skipped."""
    print("SKIPPED: " + reason)
    sys.stdout.flush()
    sys.exit(SKIPPED)


def load_plugin(remote=False):
    """Makes the plugin's proxies known, here and (remote) on the server."""
    LoadPlugin(PLUGIN, remote=remote, ns=globals())


def shared_data(name):
    """Path of a file of ../shared/data; skips the test where it is absent."""
    path = os.path.join(SOURCE_DIR, "..", "shared", "data", name)
    if not os.path.exists(path):
        skip("../shared/data/%s is not there" % name)
    return os.path.abspath(path)


def temp_file(name):
    return os.path.join(TEMP_DIR, name)


# --- reading results -------------------------------------------------------------------------
def fetch(proxy, port=0):
    """The data of an output port, on the client."""
    proxy.UpdatePipeline()
    return servermanager.Fetch(proxy, idx=port)


def array(data, name, association="point"):
    """A point, cell or field array as numpy array; fails, listing what is there, if it is missing."""
    attributes = getattr(data, "Get%sData" % association.capitalize())()
    a = attributes.GetArray(name)
    there = [attributes.GetArrayName(i) for i in range(attributes.GetNumberOfArrays())]
    assert a is not None, "no %s array %s; there are %s" % (association, name, there)
    return vtk_to_numpy(a)


def field(data, name):
    """A field array as flat numpy array."""
    return array(data, name, "field").ravel()


def points(data):
    return dataset_adapter.WrapDataObject(data).Points


# --- assertions ------------------------------------------------------------------------------
def check(condition, what):
    assert condition, what


def check_equal(value, expected, what):
    assert value == expected, "%s is %r, expected %r" % (what, value, expected)


def check_close(value, expected, tolerance, what):
    ok = abs(value - expected) <= tolerance  # false for NaN
    assert ok, "%s is %g, expected %g +- %g" % (what, value, expected, tolerance)


def check_between(value, low, high, what):
    assert low <= value <= high, "%s is %g, expected %g..%g" % (what, value, low, high)


class Errors:
    """Keeps the errors of a proxy's VTK object and of its executive while inside `with`.

    Needs the builtin server: a remote proxy has no object on the client.

        with Errors(f) as errors:
            f.UpdatePipeline()
        errors.check_one("Radius")
    """

    def __init__(self, proxy):
        algorithm = proxy.GetClientSideObject()
        self._objects = (algorithm, algorithm.GetExecutive())
        self._tags = []
        self.messages = []  # of the algorithm
        self.pipeline = []  # of the executive, which repeats that something failed

    def __enter__(self):
        for watched, messages in zip(self._objects, (self.messages, self.pipeline)):

            def note(caller, event, data, messages=messages):
                messages.append(data)

            note.CallDataType = "string0"
            self._tags.append((watched, watched.AddObserver("ErrorEvent", note)))
        return self

    def __exit__(self, *unused):
        for watched, tag in self._tags:
            watched.RemoveObserver(tag)
        return False

    def check_none(self):
        assert not self.messages + self.pipeline, self.messages + self.pipeline

    def check_one(self, text):
        """Exactly one error, and it contains `text`."""
        said = self.messages or self.pipeline
        assert len(said) == 1, "expected one error with %r, got %r" % (text, said)
        assert text in said[0], "%r not in %r" % (text, said[0])


# --- pictures --------------------------------------------------------------------------------
def make_view(size=(400, 300)):
    """A render view of fixed look: no axes, no annotations, white background, no antialiasing."""
    view = CreateView("RenderView")
    view.ViewSize = list(size)
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = [1, 1, 1]
    view.MultiSamples = 1 if "MultiSamples" in view.ListProperties() else 0
    return view


def check_picture(view, name, threshold=1.0):
    """Compares with Testing/Baseline/<name>.png (or <name>_1.png ...).

    With BSR_UPDATE_BASELINES set the baseline is written instead; look at it before adding it.
    """
    baseline = os.path.join(SOURCE_DIR, "Testing", "Baseline", name + ".png")
    view.StillRender()  # Render() of paraview.simple would reset the camera the first time
    if os.environ.get("BSR_UPDATE_BASELINES"):
        SaveScreenshot(baseline, view, ImageResolution=view.ViewSize)
        print("wrote " + baseline)
        return
    assert os.path.exists(baseline), "no " + baseline
    testing = vtkSMTesting()
    for argument in ("-T", TEMP_DIR, "-V", baseline):
        testing.AddArgument(argument)
    testing.SetRenderViewProxy(view.SMProxy)
    ok = testing.RegressionTest(threshold)
    assert ok == 1, "the picture differs from %s by more than %g" % (baseline, threshold)


load_plugin()
