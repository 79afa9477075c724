"""Actors for a rendering.Stage, made from recorded frames: smooth-shaded skin, tets cut open, and bones; and the points
of a frame.

    picture = stage.shot([bodies.skin(frames.skin("pbs", 12)), *bodies.bones(frames.bones(12))], camera)
"""
import numpy
from vtkmodules.all import vtkExtractCells  # its module differs between VTK 9.1 and 9.3
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkCutter, vtkPolyDataNormals, vtkTubeFilter
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersSources import vtkLineSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkPolyDataMapper

import records
from drawing import rendering
from drawing.rendering import made, output_of

bone_color, flesh_color, edge_color = (0.15, 0.15, 0.15), (0.80, 0.55, 0.47), (0.25, 0.2, 0.2)


def surface(data):
    """The boundary of the data with normals for smooth shading."""
    boundary = made(vtkDataSetSurfaceFilter, InputData=data)
    return output_of(made(vtkPolyDataNormals, InputConnection=boundary.GetOutputPort(), Splitting=False))


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
    data.SetPoints(made(vtkPoints, Data=data.GetPointData().GetArray("rest_position")))
    return data


def distances_mm(frames, frame, one, other):
    """The distance of each point of the rendered surface under one deformer from that under another, #S."""
    first, second = (points_of(frames.skin(label, frame)) for label in (one, other))
    return 1000 * numpy.linalg.norm(first - second, axis=1)


def bone_under(frames, point, tet_file):
    """The nearest bone of the vertex that carries the largest share of this point of the rendered surface."""
    tets, shares = frames.embedding()
    carrier = int(rendering.corners_of(rendering.read(tet_file))[tets[point]][numpy.argmax(shares[point])])
    return next(row["bone"] for row in frames.binding() if int(row["vertex"]) == carrier)


def _actor(data, color, ambient=0.25, **settings):
    return rendering.actor_of(made(vtkPolyDataMapper, InputData=data, ScalarVisibility=False), ambient, Color=color,
                              **settings)


def skin(file, color=rendering.skin_color, ambient=0.25, opacity=1.0):
    return _actor(surface(file if hasattr(file, "GetPoints") else rendering.read(file)), color, ambient,
                  Opacity=opacity)


def skin_by(file, values, scale, colors, steps=256):
    """The skin coloured by one number per point."""
    data = rendering.read(file)
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName("shown")
    data.GetPointData().SetScalars(array)
    table = rendering.table_of(scale.vmin, scale.vmax, [colors(step / (steps - 1)) for step in range(steps)])
    mapper = made(vtkPolyDataMapper, InputData=surface(data), LookupTable=table, UseLookupTableScalarRange=True)
    return rendering.actor_of(mapper, ambient=0.6)


def cut_open(data, ahead_m):
    """The tets behind a cut, with their edges drawn. ahead_m: the distance of each point in front of the cut."""
    chosen = vtkIdList()
    for cell in numpy.flatnonzero(ahead_m[rendering.corners_of(data)].mean(axis=1) < 0):
        chosen.InsertNextId(int(cell))
    kept = made(vtkExtractCells, InputData=data, CellList=chosen)
    boundary = output_of(made(vtkDataSetSurfaceFilter, InputConnection=kept.GetOutputPort()))
    actor = _actor(boundary, flesh_color, ambient=0.4, EdgeVisibility=True, EdgeColor=edge_color, LineWidth=0.8)
    actor.GetProperty().SetInterpolationToFlat()
    return actor


def section(file, place, normal):
    """The cut of the tets by a plane, half transparent, so that flesh in other flesh is darker."""
    plane = made(vtkPlane, Origin=tuple(place), Normal=tuple(normal))
    cut = output_of(made(vtkCutter, InputData=rendering.read(file), CutFunction=plane, GenerateTriangles=False))
    return _actor(cut, flesh_color, ambient=1.0, Opacity=0.5, EdgeVisibility=True, EdgeColor=edge_color, LineWidth=0.6)


def bones(posed, radius_m=0.008, towards=(0.0, 0.0, 0.0), color=bone_color):
    """Each bone as a rod between its end points, with balls at its joints. Bones moved towards a parallel camera are
    hidden by nothing."""
    actors = []
    for ends in ((tuple(bone.head + numpy.array(towards)), tuple(bone.tail + numpy.array(towards))) for bone in posed):
        line = made(vtkLineSource, Point1=ends[0], Point2=ends[1])
        rod = made(vtkTubeFilter, InputConnection=line.GetOutputPort(), Radius=radius_m, NumberOfSides=16)
        balls = [made(vtkSphereSource, Center=end, Radius=1.8 * radius_m, ThetaResolution=20, PhiResolution=20)
                 for end in ends]
        actors += [_actor(output_of(shape), color) for shape in (rod, *balls)]
    return actors
