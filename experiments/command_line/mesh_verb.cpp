// pbskin mesh SURFACE -o TETS [--vertices N]: turns a closed or nearly closed surface into a tet mesh of about the wanted size.
#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/geometry/meshing.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>

namespace experiments {
namespace {

struct MeshArguments {
    std::string surface, tets;
    pbs::SurfaceMeshing meshing;
    int boundary_euler = 2;
    double scale = 1.0;
};

// The mesher does not know the name of the file.
pbs::TetMesh meshed(const MeshArguments& arguments, const pbs::SurfaceMesh& surface)
{
    try {
        return pbs::mesh_surface(surface, arguments.meshing);
    } catch (const pbs::InputError& error) {
        throw pbs::InputError(arguments.surface, 0, "", "", error.what());
    }
}

int mesh(const MeshArguments& arguments)
{
    std::vector<std::string> remarks;
    const pbs::SurfaceMesh surface = pbs::read_surface(arguments.surface, remarks, arguments.scale);
    warn(remarks);
    pbs::require_tet_mesh_format(arguments.tets);
    analysis::require_writable(arguments.tets);
    const pbs::TetMesh mesh = meshed(arguments, surface);
    pbs::write_tet_mesh(arguments.tets, mesh);
    fmt::print("{}", pbs::describe(pbs::quality_of(mesh)));
    return exit_finished;
}

}  // namespace

void add_mesh_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "mesh", "turns a closed or nearly closed surface into tets and prints their quality");
    auto arguments = std::make_shared<MeshArguments>();
    verb->add_option("surface", arguments->surface, ".obj .ply .off .stl .gltf .glb .dae .zae .fbx, in metres")->required();
    verb->add_option("-o,--output", arguments->tets, ".msh .vtu .mesh")->required();
    verb->add_option("--vertices", arguments->meshing.vertices, "wanted number of vertices")
        ->check(CLI::Range(150, 10'000'000))
        ->capture_default_str();
    verb->add_option("--wrap-alpha", arguments->meshing.wrap_alpha_m, "alpha of the wrap [m]; 0: computed from the size of the body")
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--euler", arguments->boundary_euler, "Euler number of the boundary: 2 for a ball, 0 for a body with one handle")
        ->capture_default_str();
    verb->add_option("--wrap-offset", arguments->meshing.wrap_offset_m, "offset of the wrap [m]; 0: a third of alpha")
        ->check(CLI::NonNegativeNumber);
    verb->add_option("--scale", arguments->scale, "enlarges the surface, for files that state a wrong unit")->check(CLI::PositiveNumber);
    verb->callback([&action, arguments] {
        arguments->meshing.boundary_euler = arguments->boundary_euler;
        action = [arguments] { return mesh(*arguments); };
    });
}

}  // namespace experiments
