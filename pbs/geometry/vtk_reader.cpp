#include "pbs/geometry/mesh_io_formats.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/vtk_messages.hpp"

#include <vtkCell.h>
#include <vtkCellTypes.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <vector>

namespace pbs {
namespace {

template <typename Reader>
vtkSmartPointer<vtkUnstructuredGrid> grid_of(const std::string& path, Reader& reader)
{
    const VtkMessages messages;
    reader.SetFileName(path.c_str());
    reader.Update();
    messages.throw_if_any(path);
    vtkSmartPointer<vtkUnstructuredGrid> grid = reader.GetOutput();
    if (!grid) throw InputError(path, 0, "", "", "expected a VTK unstructured grid");
    return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::string& path)
{
    if (beginning_of(path).starts_with("# vtk DataFile")) {  // either format may have either extension
        vtkNew<vtkUnstructuredGridReader> reader;
        return grid_of(path, *reader.Get());
    }
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    return grid_of(path, *reader.Get());
}

bool is_lower_dimensional(int type)
{
    return type == VTK_VERTEX || type == VTK_POLY_VERTEX || type == VTK_LINE || type == VTK_POLY_LINE || type == VTK_TRIANGLE ||
           type == VTK_TRIANGLE_STRIP || type == VTK_POLYGON || type == VTK_PIXEL || type == VTK_QUAD;
}

// The cells that are tets; other volume cells are refused.
std::vector<vtkIdType> tet_cells(const std::string& path, vtkUnstructuredGrid& grid)
{
    std::vector<vtkIdType> cells;
    for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
        const int type = grid.GetCellType(cell);
        if (type == VTK_TETRA)
            cells.push_back(cell);
        else if (!is_lower_dimensional(type))
            throw InputError(path, 0, "cell " + std::to_string(cell), vtkCellTypes::GetClassNameFromTypeId(type),
                             "expected four-node tetrahedra (VTK_TETRA)");
    }
    return cells;
}

}  // namespace

IndexedPoints read_vtk(const std::string& path)
{
    const vtkSmartPointer<vtkUnstructuredGrid> grid = read_grid(path);
    const std::vector<vtkIdType> cells = tet_cells(path, *grid);
    const vtkIdType points = grid->GetNumberOfPoints();

    IndexedPoints mesh;
    mesh.points.resize(points, 3);
    for (vtkIdType i = 0; i < points; ++i) grid->GetPoint(i, mesh.points.row(i).data());
    mesh.cells.resize(static_cast<Eigen::Index>(cells.size()), 4);
    vtkNew<vtkIdList> corners;
    for (std::size_t t = 0; t < cells.size(); ++t) {
        grid->GetCellPoints(cells[t], corners);
        if (corners->GetNumberOfIds() != 4)
            throw InputError(path, 0, "cell " + std::to_string(cells[t]) + " vertices", std::to_string(corners->GetNumberOfIds()),
                             "expected 4");
        for (int corner = 0; corner < 4; ++corner)
            mesh.cells(static_cast<Eigen::Index>(t), corner) =
                checked_index(path, static_cast<long long>(t), corners->GetId(corner), points);
    }
    return mesh;
}

}  // namespace pbs
