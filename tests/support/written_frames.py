"""Meshes as VTK has them: those that the program writes, read by VTK and not by the program's own code, and surfaces
for it to read."""
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def read(path):
    """The data set of a .vtu or .vtp file."""
    reader = vtk.vtkXMLUnstructuredGridReader() if str(path).endswith(".vtu") else vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def points(grid):
    """#P x 3 [m]"""
    return vtk_to_numpy(grid.GetPoints().GetData())


def tets(grid):
    """#T x 4"""
    return vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)


def points_of(path):
    return points(read(path))


def signed_volumes(grid):
    """The volume of each tet [m^3]."""
    a, b, c, d = (points(grid).astype(numpy.float64)[tets(grid)[:, corner]] for corner in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6.0


def surface(vertices, faces):
    """Returns polygons as a data set of VTK. vertices: #V x 3; faces: the corners of each."""
    polygons, cloud, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
    cloud.SetDataTypeToDouble()
    for vertex in vertices:
        cloud.InsertNextPoint(vertex)
    for face in faces:
        cells.InsertNextCell(len(face), face)
    polygons.SetPoints(cloud)
    polygons.SetPolys(cells)
    return polygons
