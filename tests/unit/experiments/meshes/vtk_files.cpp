// Reference: the unit tet by hand, with what other programs add to it.
#include "experiments/meshes/mesh_io.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace vtk_files_tests {
namespace {

using VtkFiles = test_support::FolderTest;
using test_support::unit_tet;

const std::string points = "0 0 0 1 0 0 0 1 0 0 0 1";

std::string array(const std::string& attributes, const std::string& values)
{
    return "<DataArray " + attributes + " format=\"ascii\">" + values + "</DataArray>\n";
}

// Cells of these types, each on the four points. data: inside of the piece.
std::string vtu(const std::string& types, const std::string& data = "")
{
    std::string corners, offsets;
    int cells = 0;
    for (const char c : types + " ")
        if (c == ' ') {
            corners += " 0 1 2 3";
            offsets += " " + std::to_string(4 * ++cells);
        }
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
           "header_type=\"UInt64\">\n"
           "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"" +
           std::to_string(cells) + "\">\n<Points>" +
           array("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", points) + "</Points>\n<Cells>" +
           array("type=\"Int64\" Name=\"connectivity\"", corners) + array("type=\"Int64\" Name=\"offsets\"", offsets) +
           array("type=\"UInt8\" Name=\"types\"", types) + "</Cells>\n" + data +
           "</Piece></UnstructuredGrid></VTKFile>\n";
}

void expect_unit_tet(const std::string& path)
{
    const pbs::MeshReading reading = pbs::read_tet_mesh(path);
    EXPECT_EQ(reading.mesh.rest, unit_tet().rest) << path;
    EXPECT_EQ(reading.mesh.tets, unit_tet().tets) << path;
}

TEST_F(VtkFiles, CallTetsOfFourNodesByAnyOfTheirNames)
{
    for (const char* type : {"10", "71", "78"}) expect_unit_tet(folder.file("a.vtu", vtu(type)));
    expect_unit_tet(folder.file("a.vtu", vtu("9 10 70")));  // a quadrangle and one of Lagrange's beside it
    const std::string path = folder.file("a.vtu", vtu("13"));
    expect_input_error([&] { pbs::read_tet_mesh(path); },
                       path + ": cell 0 = vtkWedge: ", "expected four-node tetrahedra");
}

TEST_F(VtkFiles, MayHaveNumbersThatAreNoneInArraysThatNoMetricNeeds)
{
    expect_unit_tet(folder.file(
        "a.vtu", vtu("10", "<PointData>" + array("type=\"Float64\" Name=\"p\"", "0 1 nan nan") + "</PointData>\n")));
    const std::string legacy = "# vtk DataFile Version 3.0\ntet\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n" +
                               points + "\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";
    expect_unit_tet(
        folder.file("a.vtk", legacy + "POINT_DATA 4\nSCALARS p double\nLOOKUP_TABLE default\n0 nan inf 1\n"));
    expect_unit_tet(folder.file("a.vtk", legacy + "CELL_DATA 1\nSCALARS p double\nLOOKUP_TABLE default\nnan\n"));
}

TEST_F(VtkFiles, OfSeveralPiecesAreReadWithoutTheCellsThatPiecesShare)
{
    const std::string ghosts = array("type=\"UInt8\" Name=\"vtkGhostType\"", "1");
    folder.file("own.vtu",
                vtu("10", "<CellData>" + array("type=\"UInt8\" Name=\"vtkGhostType\"", "0") + "</CellData>\n"));
    folder.file("shared.vtu", vtu("10", "<CellData>" + ghosts + "</CellData>\n"));
    const auto pvtu = [&](const std::string& pieces) {
        return folder.file(
            "a.pvtu",
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
            "byte_order=\"LittleEndian\">\n"
            "<PUnstructuredGrid GhostLevel=\"1\"><PCellData><PDataArray type=\"UInt8\" "
            "Name=\"vtkGhostType\"/></PCellData>"
            "<PPoints><PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/></PPoints>" +
                pieces + "</PUnstructuredGrid></VTKFile>\n");
    };
    expect_unit_tet(pvtu("<Piece Source=\"own.vtu\"/>"));
    expect_unit_tet(pvtu("<Piece Source=\"own.vtu\"/><Piece Source=\"shared.vtu\"/>"));
    const std::string path = pvtu("<Piece Source=\"none.vtu\"/>");
    EXPECT_THROW(pbs::read_tet_mesh(path), pbs::InputError);
}

TEST_F(VtkFiles, OfCollectionsAreListedByTime)
{
    const std::string path = folder / "a.pvd";
    pbs::write_pvd(path, {{1.0, "b.vtu"}, {0.5, "frames/a.vtu"}});
    EXPECT_EQ(pbs::read_pvd(path), (std::vector{folder / "frames/a.vtu", folder / "b.vtu"}));
    expect_input_error([&] { pbs::read_tet_frame(path); }, path + ": ", ".pvd");
    pbs::write_pvd(path, {{1.0, "a.vtu"}, {1.0, "b.vtu"}});
    expect_input_error([&] { pbs::read_pvd(path); }, path + ": timestep = 1: ", "expected one file for each");
    folder.file(
        "a.pvd",
        "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"1\" file=\"a.vtu\"/><DataSet file=\"b.vtu\"/>"
        "</Collection></VTKFile>");
    expect_input_error([&] { pbs::read_pvd(path); }, path + ": timestep = 1: ", "expected one file for each");
    folder.file("a.pvd", "<VTKFile type=\"UnstructuredGrid\"/>");
    expect_input_error([&] { pbs::read_pvd(path); }, path + ": ", "expected a ParaView collection");
    folder.file("a.pvd", "no markup");
    expect_input_error([&] { pbs::read_pvd(path); }, path + ": ", "expected a ParaView collection");
}

}  // namespace
}  // namespace vtk_files_tests
