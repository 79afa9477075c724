// Reference: another program. Gmsh and VTK's Python write files that this code reads, and read files that it writes, to
// the bit.
#include "experiments/meshes/mesh_io.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"

#include <gmsh.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

namespace {

using Gmsh = test_support::FolderTest;
using Vtk = test_support::FolderTest;
using test_support::ScratchFolder;

pbs::TetMesh bar()
{
    return test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {7, 3, 3});
}

void write_by_gmsh(const std::string& path, double version, bool binary)
{
    const pbs::TetMesh mesh = bar();
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("Mesh.MshFileVersion", version);
    gmsh::option::setNumber("Mesh.Binary", binary);
    gmsh::model::addDiscreteEntity(3, 1);
    std::vector<std::size_t> nodes(std::size_t(mesh.rest.rows())), tets(std::size_t(mesh.tets.rows())), corners;
    std::iota(nodes.begin(), nodes.end(), 1u);
    std::iota(tets.begin(), tets.end(), 1u);
    for (const int v : mesh.tets.reshaped<Eigen::RowMajor>()) corners.push_back(std::size_t(v) + 1);
    gmsh::model::mesh::addNodes(3, 1, nodes, {mesh.rest.data(), mesh.rest.data() + mesh.rest.size()});
    gmsh::model::mesh::addElementsByType(1, 4, tets, corners);
    gmsh::write(path);
    gmsh::finalize();
}

TEST_F(Gmsh, FilesOfBothVersionsAsciiAndBinaryAreRead)
{
    for (const double version : {2.2, 4.1})
        for (const bool binary : {false, true}) {
            const std::string path = folder / (std::to_string(version) + (binary ? "b.msh" : "a.msh"));
            write_by_gmsh(path, version, binary);
            const pbs::MeshReading reading = pbs::read_tet_mesh(path);
            EXPECT_EQ(reading.mesh.tets, bar().tets) << path;
            // Gmsh's ASCII files have 16 significant digits of coordinates up to 1, its binary files have all.
            const double of_digits = binary ? 0.0 : 0.5e-15 + test_support::rounding_error(1, 1.0);
            EXPECT_LE((reading.mesh.rest - bar().rest).cwiseAbs().maxCoeff(), of_digits) << path;
        }
}

// Gmsh lists vertices by entity; rest mesh and frames must agree on the numbers in the file.
TEST_F(Gmsh, VerticesKeepTheOrderOfTheirTags)
{
    const std::string path = folder / "two_entities.msh";
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::model::addDiscreteEntity(3, 1);
    gmsh::model::addDiscreteEntity(3, 2);
    gmsh::model::mesh::addNodes(3, 1, {3, 4}, {0, 1, 0, 0, 0, 1});
    gmsh::model::mesh::addNodes(3, 2, {1, 2, 5}, {0, 0, 0, 1, 0, 0, 0, 0, -1});
    gmsh::model::mesh::addElementsByType(1, 4, {2}, {1, 2, 3, 4});
    gmsh::model::mesh::addElementsByType(2, 4, {1}, {1, 3, 2, 5});
    gmsh::write(path);
    gmsh::finalize();
    const pbs::TetMesh mesh = pbs::read_tet_mesh(path).mesh;
    EXPECT_EQ(mesh.rest, (pbs::Positions(5, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1).finished());
    EXPECT_EQ(mesh.tets, (pbs::Tets(2, 4) << 0, 2, 1, 4, 0, 1, 2, 3).finished());
}

// Runs Python with VTK; `script` finds the paths in sys.argv.
int python(const std::string& script, const std::string& paths)
{
    return std::system((PBS_TEST_PYTHON " -B -c '" + script + "' " + paths).c_str());
}

TEST_F(Vtk, ReadsTheFramesWeWriteToTheBit)
{
    const pbs::TetMesh mesh = bar();
    pbs::FrameFields fields;
    fields.point_vectors["displacement"] = mesh.rest / 3.0;
    fields.point_flags["prescribed"] = std::vector<int>(std::size_t(mesh.rest.rows()), 1);
    fields.cell_scalars["volume_ratio"] = Eigen::VectorXd::LinSpaced(mesh.tets.rows(), 0.0, 1.0) / 3.0;
    pbs::write_vtu(folder / "frame.vtu", mesh.rest, mesh.tets, fields);
    ASSERT_EQ(python(R"(
import sys, vtk
reader = vtk.vtkXMLUnstructuredGridReader(); reader.SetFileName(sys.argv[1]); reader.Update(); grid = reader.GetOutput()
points, cells = grid.GetPointData(), grid.GetCellData()
out = open(sys.argv[2], "w")
def put(array):
    assert array.GetDataTypeAsString() in ("double", "int")
    for i in range(array.GetNumberOfTuples()): out.write(" ".join(float(x).hex() for x in array.GetTuple(i)) + "\n")
put(grid.GetPoints().GetData()); put(points.GetArray("displacement")); put(points.GetArray("prescribed"))
put(cells.GetArray("volume_ratio"))
assert all(grid.GetCellType(c) == vtk.VTK_TETRA for c in range(grid.GetNumberOfCells()))
)",
                     (folder / "frame.vtu") + " " + (folder / "numbers")),
              0);
    std::vector<double> expected(mesh.rest.data(), mesh.rest.data() + mesh.rest.size());
    for (const double x : fields.point_vectors["displacement"].reshaped<Eigen::RowMajor>()) expected.push_back(x);
    expected.insert(expected.end(), std::size_t(mesh.rest.rows()), 1.0);
    for (const double x : fields.cell_scalars["volume_ratio"]) expected.push_back(x);
    std::ifstream file(folder / "numbers");
    std::vector<double> found;
    for (std::string number; file >> number;) found.push_back(std::strtod(number.c_str(), nullptr));
    EXPECT_EQ(found, expected);
}

TEST_F(Vtk, FilesOfEveryKindItWritesAreReadToTheBit)
{
    pbs::write_tet_mesh(folder / "bar.vtu", bar());
    ASSERT_EQ(python(R"(
import sys, vtk
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1] + "/bar.vtu")
reader.Update()
def write(writer, name):
    writer.SetInputConnection(reader.GetOutputPort())
    writer.SetFileName(sys.argv[1] + "/" + name)
    assert writer.Write()
for mode in ("Ascii", "Binary", "Appended"):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    getattr(writer, "SetDataModeTo" + mode)()
    writer.EncodeAppendedDataOff()
    write(writer, mode + ".vtu")
for mode in ("ASCII", "Binary"):
    writer = vtk.vtkUnstructuredGridWriter()
    getattr(writer, "SetFileTypeTo" + mode)()
    write(writer, mode + ".vtk")
)",
                     folder.path().string()),
              0);
    for (const char* name : {"Ascii.vtu", "Binary.vtu", "Appended.vtu", "ASCII.vtk", "Binary.vtk"}) {
        const pbs::MeshReading reading = pbs::read_tet_mesh(folder / name);
        // VTK writes this format with fewer digits
        const double digits = std::string(name) == "ASCII.vtk" ? 1e-8 : 0.0;
        EXPECT_LE((reading.mesh.rest - bar().rest).cwiseAbs().maxCoeff(), digits) << name;
        EXPECT_EQ(reading.mesh.tets, bar().tets) << name;
    }
}

TEST_F(Vtk, ReadsTheSurfacesAndCollectionsWeWrite)
{
    const pbs::Triangles two = (pbs::Triangles(2, 3) << 0, 1, 2, 0, 2, 3).finished();
    pbs::write_vtp(folder / "skin.vtp", bar().rest, two);
    pbs::write_pvd(folder / "skin.pvd", {{0.5, "skin.vtp"}});
    EXPECT_EQ(python(R"(
import sys, vtk, xml.etree.ElementTree as tree
folder = sys.argv[1]
set = tree.parse(folder + "/skin.pvd").getroot().find("Collection/DataSet")
assert float(set.get("timestep")) == 0.5
reader = vtk.vtkXMLPolyDataReader(); reader.SetFileName(folder + "/" + set.get("file")); reader.Update()
assert reader.GetOutput().GetNumberOfPolys() == 2 and reader.GetOutput().GetNumberOfPoints() == 128
)",
                     folder.path().string()),
              0);
}

}  // namespace
