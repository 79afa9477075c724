// Any bytes as a file that the program itself reads, selected by their first byte: TetGen's pair (separated by a zero
// byte), .tobj, .msh, .mesh, .obj, weights and IQM. The result is valid, or an InputError.
#include "experiments/characters/named_bodies.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/meshes/mesh_io_formats.hpp"
#include "tests/fuzz/target.hpp"

#include <algorithm>
#include <cmath>

namespace {

using fuzz::expect;
using fuzz::written;

const pbs::Skeleton arm = {
    {{"upper", -1, pbs::Vec3(-1, 0, 0), pbs::Vec3::Zero()}, {"forearm", 0, pbs::Vec3::Zero(), pbs::Vec3(1, 0, 0)}}};
constexpr int vertices = 4;

void expect_valid(const pbs::TetMesh& mesh)
{
    if (mesh.tets.size() > 0) expect(mesh.tets.minCoeff() >= 0 && mesh.tets.maxCoeff() < mesh.rest.rows());
}

void try_tetgen(const std::string& bytes)
{
    const std::size_t parting = std::min(bytes.find('\0'), bytes.size());
    written("fuzz.ele", bytes.substr(std::min(parting + 1, bytes.size())));
    expect_valid(pbs::read_tetgen(written("fuzz.node", bytes.substr(0, parting))));
}

void try_weights(const std::string& bytes)
{
    const pbs::Weights weights = pbs::parse_weights(bytes, "fuzz.csv", arm, vertices);
    expect(weights.first.size() == vertices + 1);
    for (int vertex = 0; vertex < vertices; ++vertex) {
        double sum = 0.0;
        for (int entry = weights.first[vertex]; entry < weights.first[vertex + 1]; ++entry)
            sum += weights.weight[entry];
        expect(std::abs(sum - 1.0) < 1e-5);
    }
}

void try_iqm(const std::string& bytes)
{
    const pbs::IqmModel model = pbs::read_iqm(written("fuzz.iqm", bytes));
    if (model.surface.triangles.size() > 0) expect(model.surface.triangles.maxCoeff() < model.surface.points.rows());
    for (int joint = 0; joint < static_cast<int>(model.joints.size()); ++joint)
        expect(model.joints[joint].parent < joint);
}

}  // namespace

void fuzz::try_input(const std::string& input)
{
    if (input.empty()) return;
    const std::string bytes = input.substr(1);
    if (input[0] == 't') try_tetgen(bytes);
    if (input[0] == 'o') expect_valid(pbs::read_tobj(written("fuzz.tobj", bytes)));
    if (input[0] == 'w') try_weights(bytes);
    if (input[0] == 'i') try_iqm(bytes);
    if (input[0] == 'm') expect_valid(pbs::read_medit(written("fuzz.mesh", bytes)));
    if (input[0] == 'g') expect_valid(pbs::read_msh(written("fuzz.msh", bytes)).mesh);
    if (input[0] == 'v') pbs::read_obj(written("fuzz.obj", bytes), "");
}
