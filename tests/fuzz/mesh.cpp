// Any bytes as the points and tets that a library has read: a valid mesh in which every tet has a volume, or an
// InputError.
#include "experiments/meshes/mesh_io_formats.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/fuzz/taken_bytes.hpp"
#include "tests/fuzz/target.hpp"

void fuzz::try_input(const std::string& bytes)
{
    TakenBytes taken(bytes);
    const std::vector<double> points = taken.take_array<double>();
    const int corners = taken.take<int>();
    const std::vector<int> tets = taken.take_array<int>();
    if (!taken.whole() || points.size() % 3 != 0 || corners != 4 || tets.size() % 4 != 0) return;
    const pbs::MeshReading reading = pbs::check_rest(
        "mesh.vtu", {Eigen::Map<const pbs::Positions>(points.data(), static_cast<Eigen::Index>(points.size() / 3), 3),
                     Eigen::Map<const pbs::Tets>(tets.data(), static_cast<Eigen::Index>(tets.size() / 4), 4)});
    expect(pbs::tet_volumes(reading.mesh.rest, reading.mesh.tets).minCoeff() > 0.0);
}
