"""Still pictures of recorded frames, rendered off screen by VTK. VTK needs a display; xvfb-run provides one on machines without a screen.

    low, high = rendering.bounds_of(folder / "lbs_000054.vtu")
    picture = rendering.Stage(width_px, height_px).picture(folder / "lbs_000054.vtu", (low + high) / 2, half_height_m)
    picture = rendering.Stage(width_px, height_px).shot([bodies.skin(file), *bodies.bones(posed)], rendering.Camera(center, half_height_m))
"""
import os
from dataclasses import dataclass

import numpy
from matplotlib import colors
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingCore import vtkActor, vtkDataSetMapper, vtkLight, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  the rendering back end

import records

ratio_scale = colors.Normalize(0.5, 1.5)  # scale of the volume ratio, the same for all pictures
# From dark to light, so that compressed and expanded tets differ in grey prints too; the colour of inverted tets is darker than all others.
ratio_colors = colors.LinearSegmentedColormap.from_list("volume ratio", ["#2C6DB5", "#B4B4B4", "#FFE54A"])
inverted_color, skin_color = (0.5, 0.0, 0.1), (0.87, 0.72, 0.62)
paper = (1.0, 1.0, 1.0)  # background of stills
view_direction = numpy.array([0.45, 0.12, 1.0])  # from the body to the camera; y is up


kept = []  # the first window stays open to the end: xvfb restarts when its last client leaves, and rejects clients at that moment


@dataclass(frozen=True)
class Camera:
    """Parallel projection: the direction from the body to the camera, and half of the height of the still [m]."""
    center: object
    half_height_m: float
    direction: object = tuple(view_direction)
    up: tuple = (0.0, 1.0, 0.0)


class Stage:
    """A window with its lights and camera."""

    def __init__(self, width_px, height_px, background=paper):
        if not os.environ.get("DISPLAY"):
            raise records.RecordsMissing("no display to render on; run under xvfb-run -a")
        self.renderer = vtkRenderer()
        self.renderer.SetBackground(*background)
        self.renderer.GetActiveCamera().ParallelProjectionOn()
        for direction, strength in (((-0.6, 0.8, 1.0), 0.9), ((1.0, 0.3, 0.6), 0.4)):
            light = vtkLight()
            light.SetLightTypeToCameraLight()
            light.SetPosition(*direction)
            light.SetIntensity(strength)
            self.renderer.AddLight(light)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(8)
        self.window.SetSize(width_px, height_px)
        self.window.AddRenderer(self.renderer)
        if not kept:
            kept.append(self.window)

    def picture(self, file, center, half_height_m):
        """The frame as an RGB array: skin smooth-shaded (.vtp), tets coloured by their volume ratio (.vtu)."""
        return self.shot([_skin(file) if file.suffix == ".vtp" else tets(file)], Camera(center, half_height_m))

    def shot(self, actors, view):
        """The actors as this camera sees them, as an RGB array."""
        for actor in actors:
            self.renderer.AddActor(actor)
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(*view.center)
        camera.SetPosition(*(numpy.array(view.center) + 10.0 * numpy.array(view.direction)))
        camera.SetViewUp(*view.up)
        camera.SetParallelScale(view.half_height_m)
        self.renderer.ResetCameraClippingRange()
        self.window.Render()
        image = vtkWindowToImageFilter()
        image.SetInput(self.window)
        image.ReadFrontBufferOff()
        image.Update()
        for actor in actors:
            self.renderer.RemoveActor(actor)
        width, height, _ = image.GetOutput().GetDimensions()
        pixels = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars())
        return pixels.reshape(height, width, -1)[::-1].copy()


def bounds_of(file):
    """Lowest and highest corner [m]."""
    bounds = numpy.array(read(file).GetBounds()).reshape(3, 2)
    return bounds[:, 0], bounds[:, 1]


def read(file):
    if not file.is_file():
        raise records.RecordsMissing(f"{file}: does not exist")
    reader = vtkXMLPolyDataReader() if file.suffix == ".vtp" else vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    if reader.GetOutput().GetNumberOfPoints() == 0:
        raise records.RecordsMissing(f"{file}: no points")
    return reader.GetOutput()


def _skin(file):
    normals = vtkPolyDataNormals()
    normals.SetInputData(read(file))
    normals.SplittingOff()
    mapper = vtkDataSetMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = actor_of(mapper, ambient=0.3)
    actor.GetProperty().SetColor(*skin_color)
    return actor


def corners_of(file):
    """The vertices of each tet, #T x 4."""
    return vtk_to_numpy(read(file).GetCells().GetConnectivityArray()).reshape(-1, 4)


def tets(file):
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(read(file))
    mapper = vtkDataSetMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("volume_ratio")
    mapper.SetLookupTable(ratio_table())
    mapper.UseLookupTableScalarRangeOn()
    actor = actor_of(mapper, ambient=0.7)
    actor.GetProperty().SetInterpolationToFlat()
    actor.GetProperty().SetDiffuse(0.3)  # little shading and no highlights, so that colours match the colour bar
    actor.GetProperty().SetSpecular(0.0)
    return actor


def ratio_table():
    """ratio_colors over ratio_scale; inverted tets (below zero) have a colour of their own."""
    steps = 600
    low, high = -ratio_scale.vmax, ratio_scale.vmax
    table = vtkLookupTable()
    table.SetNumberOfTableValues(steps)
    table.SetRange(low, high)
    for step in range(steps):
        ratio = low + (step + 0.5) * (high - low) / steps
        red, green, blue, _ = (*inverted_color, 1.0) if ratio <= 0 else ratio_colors(ratio_scale(ratio))
        table.SetTableValue(step, red, green, blue, 1.0)
    table.Build()
    return table


def actor_of(mapper, ambient):
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetAmbient(ambient)
    actor.GetProperty().SetDiffuse(1.0 - ambient)
    actor.GetProperty().SetSpecular(0.05)
    return actor
