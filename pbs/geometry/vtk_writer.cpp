#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/atomic_file.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/vtk_messages.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <locale>
#include <sstream>

namespace pbs {
namespace {

void require_length(const std::string& path, const std::string& field, Eigen::Index length, Eigen::Index expected)
{
    if (length != expected)
        throw InputError(path, 0, field, std::to_string(length), "expected " + std::to_string(expected) + " entries, one each");
}

vtkSmartPointer<vtkDoubleArray> vectors_of(const std::string& name, const Positions& values)
{
    auto array = vtkSmartPointer<vtkDoubleArray>::New();
    array->SetName(name.c_str());
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(values.rows());
    std::copy(values.data(), values.data() + values.size(), array->GetPointer(0));
    return array;
}

vtkSmartPointer<vtkPoints> points_of(const Positions& positions)
{
    auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetDataTypeToDouble();
    points->SetData(vectors_of("points", positions));
    return points;
}

template <typename Cells>
vtkSmartPointer<vtkCellArray> cells_of(const Cells& indices)
{
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    for (Eigen::Index c = 0; c < indices.rows(); ++c) {
        cells->InsertNextCell(static_cast<int>(indices.cols()));
        for (Eigen::Index corner = 0; corner < indices.cols(); ++corner) cells->InsertCellPoint(indices(c, corner));
    }
    return cells;
}

void add_fields(const std::string& path, const FrameFields& fields, vtkUnstructuredGrid& grid)
{
    for (const auto& [name, values] : fields.point_vectors) {
        require_length(path, name, values.rows(), grid.GetNumberOfPoints());
        grid.GetPointData()->AddArray(vectors_of(name, values));
    }
    for (const auto& [name, flags] : fields.point_flags) {
        require_length(path, name, static_cast<Eigen::Index>(flags.size()), grid.GetNumberOfPoints());
        vtkNew<vtkIntArray> array;
        array->SetName(name.c_str());
        array->SetNumberOfTuples(grid.GetNumberOfPoints());
        std::copy(flags.begin(), flags.end(), array->GetPointer(0));
        grid.GetPointData()->AddArray(array);
    }
    for (const auto& [name, values] : fields.cell_scalars) {
        require_length(path, name, values.size(), grid.GetNumberOfCells());
        vtkNew<vtkDoubleArray> array;
        array->SetName(name.c_str());
        array->SetNumberOfTuples(values.size());
        std::copy(values.data(), values.data() + values.size(), array->GetPointer(0));
        grid.GetCellData()->AddArray(array);
    }
}

// Into memory: VTK does not say what a file system refuses.
void write_xml(const std::string& path, vtkXMLWriter& writer)
{
    const VtkMessages messages;
    writer.WriteToOutputStringOn();
    writer.SetDataModeToAppended();
    writer.SetCompressorTypeToZLib();
    const int written = writer.Write();
    messages.throw_if_any(path);
    if (!written) throw InputError(path, 0, "", "", "cannot be written");
    write_atomically(path, writer.GetOutputString());
}

}  // namespace

void write_vtu(const std::string& path, const Positions& points, const Tets& tets, const FrameFields& fields)
{
    vtkNew<vtkUnstructuredGrid> grid;
    grid->SetPoints(points_of(points));
    grid->SetCells(VTK_TETRA, cells_of(tets));
    add_fields(path, fields, *grid);
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid);
    write_xml(path, *writer);
}

void write_vtp(const std::string& path, const Positions& points, const Triangles& triangles)
{
    vtkNew<vtkPolyData> surface;
    surface->SetPoints(points_of(points));
    surface->SetPolys(cells_of(triangles));
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(surface);
    write_xml(path, *writer);
}

void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& frames)
{
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(17);
    text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
    for (const auto& [time_s, name] : frames) text << "    <DataSet timestep=\"" << time_s << "\" part=\"0\" file=\"" << name << "\"/>\n";
    text << "  </Collection>\n</VTKFile>\n";
    write_atomically(path, text.str());
}

}  // namespace pbs
