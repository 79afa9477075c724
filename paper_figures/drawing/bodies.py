"""Actors for a rendering.Stage, made from recorded frames: smooth-shaded skin, tets by volume ratio, tets cut open, and bones.

    picture = stage.shot([bodies.skin(frames.skin("pbs", 12)), *bodies.bones(frames.bones(12))], camera)
"""
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkLookupTable, vtkPoints
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals, vtkTubeFilter
from vtkmodules.vtkFiltersExtraction import vtkExtractCells
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersSources import vtkLineSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkPolyDataMapper

import records
from drawing import rendering

bone_color, flesh_color, edge_color = (0.15, 0.15, 0.15), (0.80, 0.55, 0.47), (0.25, 0.2, 0.2)


def surface(data):
    """The boundary of the data with normals for smooth shading."""
    boundary = vtkDataSetSurfaceFilter()
    boundary.SetInputData(data)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(boundary.GetOutputPort())
    normals.SplittingOff()
    normals.Update()
    return normals.GetOutput()


def points_of(file):
    """Positions [m], #V x 3."""
    return vtk_to_numpy(rendering.read(file).GetPoints().GetData())


def rest_positions_of(file):
    array = rendering.read(file).GetPointData().GetArray("rest_position")
    if array is None:
        raise records.RecordsMissing(f"{file}: no rest_position at its points")
    return vtk_to_numpy(array)


def at_rest(file):
    """The tets of the frame at their rest positions."""
    data = rendering.read(file)
    points = vtkPoints()
    points.SetData(data.GetPointData().GetArray("rest_position"))
    data.SetPoints(points)
    return data


def _actor(data, color, ambient=0.25):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = rendering.actor_of(mapper, ambient)
    actor.GetProperty().SetColor(*color)
    return actor


def skin(file, color=rendering.skin_color):
    return _actor(surface(rendering.read(file)), color)


def glass(data, color=rendering.skin_color, opacity=0.3):
    """A transparent skin."""
    actor = _actor(surface(data), color, ambient=0.6)
    actor.GetProperty().SetOpacity(opacity)
    return actor


def skin_by(file, values, scale, colors):
    """The skin coloured by one number per point."""
    data = rendering.read(file)
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName("shown")
    data.GetPointData().SetScalars(array)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(surface(data))
    mapper.SetLookupTable(_shades(scale, colors))
    mapper.UseLookupTableScalarRangeOn()
    return rendering.actor_of(mapper, ambient=0.6)


def _shades(scale, colors, steps=256):
    table = vtkLookupTable()
    table.SetNumberOfTableValues(steps)
    table.SetRange(scale.vmin, scale.vmax)
    for step in range(steps):
        table.SetTableValue(step, *colors(step / (steps - 1)))
    table.Build()
    return table


def cut_open(data, ahead_m):
    """The tets behind a cut, with their edges drawn. ahead_m: the distance of each point in front of the cut."""
    corners = vtk_to_numpy(data.GetCells().GetConnectivityArray()).reshape(-1, 4)
    chosen = vtkIdList()
    for cell in numpy.flatnonzero(ahead_m[corners].mean(axis=1) < 0):
        chosen.InsertNextId(int(cell))
    kept = vtkExtractCells()
    kept.SetInputData(data)
    kept.SetCellList(chosen)
    boundary = vtkDataSetSurfaceFilter()
    boundary.SetInputConnection(kept.GetOutputPort())
    boundary.Update()
    actor = _actor(boundary.GetOutput(), flesh_color, ambient=0.4)
    actor.GetProperty().SetInterpolationToFlat()
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(*edge_color)
    actor.GetProperty().SetLineWidth(0.8)
    return actor


def bones(posed, radius_m=0.008, towards=(0.0, 0.0, 0.0), color=bone_color):
    """Each bone as a rod between its end points, with balls at its joints. Bones moved towards a parallel camera are hidden by nothing."""
    ends = [(bone.head + numpy.array(towards), bone.tail + numpy.array(towards)) for bone in posed]
    return [actor for head, tail in ends for actor in (_rod(head, tail, radius_m, color), ball(head, 1.8 * radius_m, color),
                                                       ball(tail, 1.8 * radius_m, color))]


def _rod(head, tail, radius_m, color):
    line = vtkLineSource()
    line.SetPoint1(*head)
    line.SetPoint2(*tail)
    tube = vtkTubeFilter()
    tube.SetInputConnection(line.GetOutputPort())
    tube.SetRadius(radius_m)
    tube.SetNumberOfSides(16)
    tube.Update()
    return _actor(tube.GetOutput(), color)


def ball(center, radius_m, color):
    sphere = vtkSphereSource()
    sphere.SetCenter(*center)
    sphere.SetRadius(radius_m)
    sphere.SetThetaResolution(20)
    sphere.SetPhiResolution(20)
    sphere.Update()
    return _actor(sphere.GetOutput(), color)
