// Any bytes as a surface or a tet mesh, whose reader is chosen by the content: the first byte chooses the name, the
// second one what is asked for. The format does not depend on the name, and the result is a surface or a mesh with
// valid indices, or an InputError. assimp and VTK read in a child process. A breakdown of theirs is counted, since the
// child contains it for users too. CGAL is left out in libFuzzer's program.
#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/guarded_reading.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/fuzz/library_child.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/fuzz/token_mutator.hpp"

#include <array>

namespace pbs {

// With limits that suit a fuzzer.
void try_reading(const std::string& path, const std::function<void(const std::string&)>& read)
{
    const fuzz::LibraryChild child([&](fuzz::LibraryChild::Parent& parent) {
        read(path);
        parent.library_is_done();
    });
    if (!child.is_whole()) throw InputError(path, 0, "", "", "refused in the child process");
}

}  // namespace pbs

namespace {

using fuzz::expect;

constexpr std::array<const char*, 12> names = {"a",     "a.obj", "a.ply", "a.gltf", "a.glb",  "a.dae",
                                               "a.fbx", "a.vtu", "a.vtk", "a.msh",  "a.tobj", "a.node"};

// an InputError is a finding, too
void expect_format_of_content(const std::string& path, const std::string& other_name) noexcept
{
    const std::string content = pbs::content_extension(path);
    expect(pbs::content_extension(other_name) == content);
    expect(pbs::format_extension(path) == (content.empty() ? pbs::lower_extension(path) : content));
    expect(pbs::lower_extension(pbs::path_by_content(path)) == pbs::format_extension(path));
}

void try_surface(const std::string& path)
{
    std::vector<std::string> remarks;
    const pbs::SurfaceMesh surface = pbs::read_surface(path, remarks);
    expect(surface.points.allFinite() && surface.triangles.rows() > 0);
    expect(surface.triangles.minCoeff() >= 0 && surface.triangles.maxCoeff() < surface.points.rows());
}

void try_tets(const std::string& path)
{
    const pbs::MeshReading reading = pbs::read_tet_mesh(path);
    expect(reading.mesh.rest.allFinite() && reading.mesh.tets.minCoeff() >= 0);
    expect(reading.mesh.tets.maxCoeff() < reading.mesh.rest.rows());
    expect(pbs::tet_volumes(reading.mesh.rest, reading.mesh.tets).minCoeff() > 0.0);
    pbs::remarks_on(path, reading);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return fuzz::mutated_tokens(data, size, most, seed, 2);
}

void fuzz::try_input(const std::string& bytes)
{
    if (bytes.size() < 2) return;
    const std::string content = bytes.substr(2),
                      path = written(names[static_cast<unsigned char>(bytes[0]) % names.size()], content);
    expect_format_of_content(path, written("b.other", content));
    bytes[1] == 't' ? try_tets(path) : try_surface(path);
}
