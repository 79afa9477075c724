"""Still pictures of recorded frames, rendered off screen by VTK. VTK needs a display; xvfb-run provides one on machines
without a screen.

    view = rendering.Camera(rendering.middle_of(file), half_height_m)
    picture = rendering.Stage(width_px, height_px).shot([bodies.skin(file), *bodies.bones(posed)], view)
"""
import os
from dataclasses import dataclass

import numpy
from matplotlib import colors
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingCore import (vtkActor, vtkDataSetMapper, vtkLight, vtkRenderer, vtkRenderWindow,
                                         vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  the rendering back end

import records

ratio_scale = colors.Normalize(0.5, 1.5)  # scale of the volume ratio, the same for all pictures
# From dark to light, so that compressed and expanded tets differ in grey prints too; the colour of inverted tets is
# darker than all others.
ratio_colors = colors.LinearSegmentedColormap.from_list("volume ratio", ["#2C6DB5", "#B4B4B4", "#FFE54A"])
inverted_color, skin_color = (0.5, 0.0, 0.1), (0.87, 0.72, 0.62)
paper = (1.0, 1.0, 1.0)  # background of stills
view_direction = numpy.array([0.45, 0.12, 1.0])  # from the body to the camera; y is up


# The first window stays open to the end: xvfb restarts when its last client leaves, and rejects clients at that moment.
kept = []


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
        records.need(os.environ.get("DISPLAY"), "no display to render on; on Debian: apt-get install xvfb xauth, "
                                                "and run under xvfb-run -a")
        self.renderer = made(vtkRenderer, Background=background)
        self.renderer.GetActiveCamera().ParallelProjectionOn()
        for direction, strength in (((-0.6, 0.8, 1.0), 0.9), ((1.0, 0.3, 0.6), 0.4)):
            light = made(vtkLight, Position=direction, Intensity=strength)
            light.SetLightTypeToCameraLight()
            self.renderer.AddLight(light)
        self.window = made(vtkRenderWindow, OffScreenRendering=1, MultiSamples=8, Size=(width_px, height_px))
        self.window.AddRenderer(self.renderer)
        if not kept:
            kept.append(self.window)

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
        image = output_of(made(vtkWindowToImageFilter, Input=self.window, ReadFrontBuffer=False))
        for actor in actors:
            self.renderer.RemoveActor(actor)
        width, height, _ = image.GetDimensions()
        return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1].copy()


def made(kind, **settings):
    """An object of VTK with these settings: made(vtkLineSource, Point1=(0, 0, 0))."""
    thing = kind()
    for name, value in settings.items():
        getattr(thing, f"Set{name}")(*value if isinstance(value, tuple) else (value,))
    return thing


def output_of(source):
    source.Update()
    return source.GetOutput()


def bounds_of(file):
    """Lowest and highest corner [m]."""
    bounds = numpy.array(read(file).GetBounds()).reshape(3, 2)
    return bounds[:, 0], bounds[:, 1]


def middle_of(file):
    return sum(bounds_of(file)) / 2


def read(file):
    records.need(file.is_file(), f"{file}: does not exist")
    data = output_of(made(vtkXMLPolyDataReader if file.suffix == ".vtp" else vtkXMLUnstructuredGridReader,
                          FileName=str(file)))
    if data.GetNumberOfPoints() == 0:
        raise records.RecordsMissing(f"{file}: no points")
    return data


def corners_of(data):
    """The vertices of each tet, #T x 4."""
    return vtk_to_numpy(data.GetCells().GetConnectivityArray()).reshape(-1, 4)


def tets(file, steps=600):
    """The tets with ratio_colors over ratio_scale; inverted tets (below zero) have a colour of their own."""
    most = ratio_scale.vmax
    ratios = [-most + (step + 0.5) * 2 * most / steps for step in range(steps)]
    table = table_of(-most, most, [(*inverted_color, 1.0) if ratio <= 0 else ratio_colors(ratio_scale(ratio))
                                   for ratio in ratios])
    surface = made(vtkDataSetSurfaceFilter, InputData=read(file))
    mapper = made(vtkDataSetMapper, InputConnection=surface.GetOutputPort(), LookupTable=table)
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("volume_ratio")
    mapper.UseLookupTableScalarRangeOn()
    # Little shading and no highlights, so that colours match the colour bar.
    actor = actor_of(mapper, ambient=0.7, Diffuse=0.3, Specular=0.0)
    actor.GetProperty().SetInterpolationToFlat()
    return actor


def table_of(low, high, colors):
    """A lookup table with these colours (red, green, blue, opacity) from the lowest to the highest value."""
    table = made(vtkLookupTable, NumberOfTableValues=len(colors), Range=(low, high))
    for step, color in enumerate(colors):
        table.SetTableValue(step, *color)
    table.Build()
    return table


def actor_of(mapper, ambient, **settings):
    """settings: of the actor's property, such as Color."""
    actor = made(vtkActor, Mapper=mapper)
    for name, value in {"Ambient": ambient, "Diffuse": 1.0 - ambient, "Specular": 0.05, **settings}.items():
        getattr(actor.GetProperty(), f"Set{name}")(value)
    return actor
