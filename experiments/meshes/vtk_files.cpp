// VTK reports errors as text on a global window. They are collected here instead of printed, a thread at a time.
//   collect_messages();  reader->Update();  throw_if_any_message(path);

#include "experiments/meshes/mesh_io_formats.hpp"
#include "experiments/meshes/text_words.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"
#include "pbs/system/source_file.hpp"

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkGenericCell.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <filesystem>
#include <locale>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace pbs {
namespace {

thread_local std::string collected;

class CollectingWindow : public vtkOutputWindow {
public:
    static CollectingWindow* New();
    vtkTypeMacro(CollectingWindow, vtkOutputWindow) void DisplayText(const char* text) override { collected += text; }
    void DisplayErrorText(const char* text) override { collected += text; }
    void DisplayWarningText(const char* text) override { collect_lost_data(text); }
    void DisplayGenericWarningText(const char* text) override { collect_lost_data(text); }
    void DisplayDebugText(const char*) override {}

private:
    // VTK only warns of numbers that are missing, and leaves the memory for them as it is.
    void collect_lost_data(const std::string& text)
    {
        if (text.find("Error reading") != std::string::npos) collected += text;
    }
};
vtkStandardNewMacro(CollectingWindow);

// "ERROR: In x.cxx, line 12\nvtkReader (0x55): words\n\n" and "Generic Warning: In x.cxx, line 12\nwords\n\n" ->
// "words"
std::string sentence_of(const std::string& message)
{
    std::size_t begin = message.find("): ");
    const std::size_t first_line = message.find('\n');
    begin = begin != std::string::npos                                           ? begin + 3
            : first_line != std::string::npos && first_line + 1 < message.size() ? first_line + 1
                                                                                 : 0;
    const std::size_t end = message.find("\n\n", begin);
    std::string words = message.substr(begin, end == std::string::npos ? end : end - begin);
    for (char& c : words)
        if (c == '\n') c = ' ';
    words.erase(std::min(words.find(" for file:"), words.size()));      // whose name stands before these words
    if (words.starts_with("Algorithm ")) return "the file is damaged";  // what follows are addresses in memory
    return words;
}

// Collects the messages that VTK reports on this thread after this call.
void collect_messages()
{
    static std::once_flag installed;
    std::call_once(installed, [] {
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
        vtkOutputWindow::SetInstance(vtkSmartPointer<CollectingWindow>::New());
    });
    collected.clear();
}

// An InputError with VTK's words, its file and line numbers taken off.
void throw_if_any_message(const std::string& path)
{
    if (!collected.empty()) throw InputError(path, 0, "", "", "VTK: " + sentence_of(collected));
}

constexpr const char* ghosts = "vtkGhostType";  // VTK's own name

template <typename Reader>
vtkSmartPointer<vtkUnstructuredGrid> grid_of(const std::string& path, Reader& reader)
{
    reader.Update();
    throw_if_any_message(path);
    vtkSmartPointer<vtkUnstructuredGrid> grid = reader.GetOutput();
    if (!grid) throw InputError(path, 0, "", "", "expected a VTK unstructured grid");
    return grid;
}

// From the bytes of the file, except one whose pieces are files of their own.
void set_source(const std::string& path, vtkXMLPUnstructuredGridReader& reader)
{
    reader.SetFileName(path.c_str());
}

void set_source(const std::string& path, vtkXMLReader& reader)
{
    reader.ReadFromInputStringOn();
    reader.SetInputString(SourceFile(path).text(most_mesh_bytes));
}

// Without the arrays of points and cells, whose defects are no matter here, except the one that marks what pieces
// share.
template <typename Reader>
vtkSmartPointer<vtkUnstructuredGrid> xml_grid(const std::string& path)
{
    collect_messages();
    vtkNew<Reader> reader;
    set_source(path, *reader.Get());
    reader->UpdateInformation();
    reader->GetPointDataArraySelection()->DisableAllArrays();
    reader->GetCellDataArraySelection()->DisableAllArrays();
    reader->GetCellDataArraySelection()->EnableArray(ghosts);
    return grid_of(path, *reader.Get());
}

// The points, cells and arrays of a file that is read as a whole. array: the only one of the points' that is read;
// empty: all.
template <typename XmlReader>
vtkSmartPointer<vtkDataObject> data_of(const std::string& path, XmlReader& reader, const std::string& array)
{
    collect_messages();
    set_source(path, reader);
    reader.UpdateInformation();
    reader.GetCellDataArraySelection()->DisableAllArrays();
    if (!array.empty()) {
        reader.GetPointDataArraySelection()->DisableAllArrays();
        reader.GetPointDataArraySelection()->EnableArray(array.c_str());
    }
    reader.Update();
    throw_if_any_message(path);
    return reader.GetOutputDataObject(0);
}

vtkSmartPointer<vtkDataObject> read_data(const std::string& path, const std::string& array)
{
    const std::string beginning = beginning_of(path);
    if (beginning.starts_with("# vtk DataFile")) {
        vtkNew<vtkGenericDataObjectReader> reader;
        reader->ReadAllVectorsOn();
        reader->ReadAllScalarsOn();  // of which some have three components
        reader->ReadAllNormalsOn();
        reader->ReadAllFieldsOn();
        collect_messages();
        reader->ReadFromInputStringOn();
        reader->SetInputString(SourceFile(path).text(most_mesh_bytes));
        reader->Update();
        throw_if_any_message(path);
        return reader->GetOutput();
    }
    if (beginning.find("\"PolyData\"") != std::string::npos) {
        vtkNew<vtkXMLPolyDataReader> reader;
        return data_of(path, *reader.Get(), array);
    }
    if (beginning.find("\"PUnstructuredGrid\"") != std::string::npos) {
        vtkNew<vtkXMLPUnstructuredGridReader> reader;
        return data_of(path, *reader.Get(), array);
    }
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    return data_of(path, *reader.Get(), array);
}

Positions points_in(vtkPointSet& data)
{
    Positions points(data.GetNumberOfPoints(), 3);
    for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) data.GetPoint(i, points.row(i).data());
    return points;
}

// The same for the older format, in which arrays come last.
vtkSmartPointer<vtkUnstructuredGrid> legacy_grid(const std::string& path)
{
    collect_messages();
    const SourceFile file(path);
    const std::string& text = file.text(most_mesh_bytes);
    vtkNew<vtkUnstructuredGridReader> reader;
    reader->ReadFromInputStringOn();
    reader->SetInputString(text.substr(0, std::min(text.find("\nPOINT_DATA "), text.find("\nCELL_DATA "))) + '\n');
    return grid_of(path, *reader.Get());
}

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::string& path)
{
    const std::string beginning = beginning_of(path);  // any of the formats may have any of the extensions
    if (beginning.starts_with("# vtk DataFile")) return legacy_grid(path);
    if (beginning.find("\"Collection\"") != std::string::npos)
        throw InputError(path, 0, "type", "Collection",
                         "expected one mesh; `pbskin measure` takes a .pvd for its frames");
    if (beginning.find("\"PUnstructuredGrid\"") != std::string::npos)
        return xml_grid<vtkXMLPUnstructuredGridReader>(path);
    return xml_grid<vtkXMLUnstructuredGridReader>(path);
}

// Tets have four nodes, by whichever of their names; a file of a program with cells of any order calls them Lagrange's
// or Bezier's.
bool is_tet(vtkUnstructuredGrid& grid, vtkIdType cell)
{
    const int type = grid.GetCellType(cell);
    if (type == VTK_TETRA) return true;
    return (type == VTK_LAGRANGE_TETRAHEDRON || type == VTK_BEZIER_TETRAHEDRON) &&
           grid.GetCells()->GetCellSize(cell) == 4;
}

// The cells that are tets, without copies of other pieces' cells; other volume cells are refused.
std::vector<vtkIdType> tet_cells(const std::string& path, vtkUnstructuredGrid& grid)
{
    vtkUnsignedCharArray* marks = vtkUnsignedCharArray::SafeDownCast(grid.GetCellData()->GetArray(ghosts));
    std::vector<vtkIdType> cells;
    for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
        if (marks && (marks->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL)) continue;
        const int type = grid.GetCellType(cell);
        const vtkSmartPointer<vtkCell> kind = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
        if (is_tet(grid, cell))
            cells.push_back(cell);
        else if (!kind || kind->GetCellDimension() == 3)
            throw InputError(path, 0, "cell " + std::to_string(cell), vtkCellTypes::GetClassNameFromTypeId(type),
                             "expected four-node tetrahedra (VTK_TETRA)");
    }
    return cells;
}

void require_length(const std::string& path, const std::string& field, Eigen::Index length, Eigen::Index expected)
{
    if (length != expected)
        throw InputError(path, 0, field, std::to_string(length),
                         "expected " + std::to_string(expected) + " entries, one each");
}

// A tuple for each row: Positions or a vector.
template <typename Values>
vtkSmartPointer<vtkDoubleArray> array_of(const std::string& name, const Values& values)
{
    auto array = vtkSmartPointer<vtkDoubleArray>::New();
    array->SetName(name.c_str());
    array->SetNumberOfComponents(Values::ColsAtCompileTime);
    array->SetNumberOfTuples(values.rows());
    std::copy(values.data(), values.data() + values.size(), array->GetPointer(0));
    return array;
}

vtkSmartPointer<vtkPoints> points_of(const Positions& positions)
{
    auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetDataTypeToDouble();
    points->SetData(array_of("points", positions));
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
        grid.GetPointData()->AddArray(array_of(name, values));
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
        grid.GetCellData()->AddArray(array_of(name, values));
    }
}

// Into memory: VTK does not say what a file system refuses.
void write_xml(const std::string& path, vtkXMLWriter& writer)
{
    collect_messages();
    writer.WriteToOutputStringOn();
    writer.SetDataModeToAppended();
    writer.SetCompressorTypeToZLib();
    const int written = writer.Write();
    throw_if_any_message(path);
    if (!written) throw InputError(path, 0, "", "", "cannot be written");
    write_atomically(path, writer.GetOutputString());
}

}  // namespace

TetMesh read_vtk(const std::string& path)
{
    const vtkSmartPointer<vtkUnstructuredGrid> grid = read_grid(path);
    const std::vector<vtkIdType> cells = tet_cells(path, *grid);
    const vtkIdType points = grid->GetNumberOfPoints();

    TetMesh mesh;
    mesh.rest.resize(points, 3);
    for (vtkIdType i = 0; i < points; ++i) grid->GetPoint(i, mesh.rest.row(i).data());
    mesh.tets.resize(static_cast<Eigen::Index>(cells.size()), 4);
    vtkNew<vtkIdList> corners;
    for (std::size_t t = 0; t < cells.size(); ++t) {
        grid->GetCellPoints(cells[t], corners);
        if (corners->GetNumberOfIds() != 4)
            throw InputError(path, 0, "cell " + std::to_string(cells[t]) + " vertices",
                             std::to_string(corners->GetNumberOfIds()), "expected 4");
        for (int corner = 0; corner < 4; ++corner)
            mesh.tets(static_cast<Eigen::Index>(t), corner) =
                checked_index(path, static_cast<long long>(t), corners->GetId(corner), points);
    }
    return mesh;
}

SurfaceMesh read_vtp(const std::string& path)
{
    const vtkSmartPointer<vtkPolyData> surface = vtkPolyData::SafeDownCast(read_data(path, ""));
    if (!surface) throw InputError(path, 0, "", "", "expected a VTK surface (PolyData)");
    SurfaceMesh mesh;
    mesh.points = points_in(*surface);
    std::vector<int> corners;
    vtkNew<vtkIdList> ids;
    vtkNew<vtkPoints> places;
    for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c) {
        vtkCell* cell = surface->GetCell(c);
        if (cell->GetCellDimension() != 2) continue;
        for (vtkIdType k = 0; k < cell->GetNumberOfPoints(); ++k)
            checked_index(path, c, cell->GetPointId(static_cast<int>(k)), mesh.points.rows());
        if (!cell->Triangulate(0, ids, places))
            throw InputError(path, 0, "face " + std::to_string(c), "", "expected an area, and no two edges that cross");
        for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k) corners.push_back(static_cast<int>(ids->GetId(k)));
    }
    mesh.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
    return mesh;
}

std::map<std::string, Eigen::MatrixXd> read_point_arrays(const std::string& path, const std::string& name)
{
    const std::string beginning = beginning_of(path);
    if (content_extension(path) == ".msh") return read_msh_point_arrays(path, name);
    if (!beginning.starts_with("# vtk DataFile") && beginning.find("<VTKFile") == std::string::npos) return {};
    const vtkSmartPointer<vtkPointSet> data = vtkPointSet::SafeDownCast(read_data(path, name));
    std::map<std::string, Eigen::MatrixXd> arrays;
    if (!data) return arrays;
    vtkPointData* fields = data->GetPointData();
    for (int a = 0; a < fields->GetNumberOfArrays(); ++a) {
        vtkDataArray* array = fields->GetArray(a);
        const int components = array && array->GetName() ? array->GetNumberOfComponents() : 0;
        if ((components != 1 && components != 3) || (!name.empty() && name != array->GetName())) continue;
        Eigen::MatrixXd& values = arrays[array->GetName()];
        values.resize(array->GetNumberOfTuples(), components);
        for (vtkIdType i = 0; i < values.rows(); ++i)
            for (int c = 0; c < components; ++c) values(i, c) = array->GetComponent(i, c);
    }
    return arrays;
}

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

std::vector<std::string> read_pvd(const std::string& path)
{
    const std::string text = as_utf8(read_text_file(path));
    const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromString(text.c_str()));
    vtkXMLDataElement* collection = root ? root->FindNestedElementWithName("Collection") : nullptr;
    if (!collection) throw InputError(path, 0, "", "", "expected a ParaView collection, <VTKFile type=\"Collection\">");
    std::map<double, std::string> files;
    for (int i = 0; i < collection->GetNumberOfNestedElements(); ++i) {
        vtkXMLDataElement* set = collection->GetNestedElement(i);
        const char *file = set->GetAttribute("file"), *time = set->GetAttribute("timestep");
        const std::optional<double> time_s = time ? number_in(time) : i;
        const std::string time_text = time ? time : std::to_string(i);
        if (!file || !time_s)
            throw InputError(path, 0, "DataSet " + std::to_string(i), time_text, "expected a timestep and a file");
        const std::filesystem::path named = std::filesystem::path(path).parent_path() / file;
        if (!files.emplace(*time_s, named.string()).second)
            throw InputError(path, 0, "timestep", time_text,
                             "expected one file for each: join its parts before the export");
    }
    std::vector<std::string> frames;
    for (const auto& [time_s, file] : files) frames.push_back(file);
    if (frames.empty()) throw InputError(path, 0, "DataSet", "", "expected at least one");
    return frames;
}

void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& frames)
{
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(17);
    text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
    for (const auto& [time_s, name] : frames)
        text << "    <DataSet timestep=\"" << time_s << "\" part=\"0\" file=\"" << name << "\"/>\n";
    text << "  </Collection>\n</VTKFile>\n";
    write_atomically(path, text.str());
}

}  // namespace pbs
