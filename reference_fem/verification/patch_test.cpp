// A displacement that is affine in x has a constant stress, needs no body force and lies in both finite element spaces: the solver must
// return it on any mesh, from displacements and from tractions on the boundary (B. Irons, A. Razzaque, 1972).
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/rounding_bound.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

namespace reference_fem {
namespace {

using pbs::Vec3;

const ElasticMaterial material{1.0, 0.3};

Vec3 affine(const Vec3& x)
{
    Eigen::Matrix3d gradient;
    gradient << 0.02, -0.03, 0.04, 0.06, 0.01, 0.02, -0.02, 0.05, -0.04;
    return Vec3(0.1, -0.05, 0.03) + gradient * x;
}

Vec3 stretched(const Vec3& x)
{
    return 0.01 * Vec3(x.x(), -material.poisson * x.y(), -material.poisson * x.z());
}

BoundaryValueProblem from_displacements(int element_order)
{
    return {.displacement = affine, .element_order = element_order};
}

// Rollers on three faces, a uniform tension of 0.01 E on the fourth.
BoundaryValueProblem from_tractions(int element_order)
{
    return {.held = [](const Vec3& x) { return Held(x.x() < 1e-9, x.y() < 1e-9, x.z() < 1e-9); },
            .element_order = element_order,
            .tractions = {{[](const Vec3& centre) { return centre.x() > 1.0 - 1e-9; },
                           [](const Vec3&, const Vec3& normal) -> Vec3 { return 0.01 * material.young_pa * normal; }}}};
}

VerificationRow row_of(const Effort& effort, const std::string& data, const BoundaryValueProblem& problem, const VectorField& exact)
{
    const int n = problem.element_order == 1 ? 5 : 3;
    const pbs::TetMesh mesh = jittered_cube(n, 0.45);
    const BoundaryValueSolution solution = solve(mesh, solver_material(effort, material), problem);
    double largest = 0.0;
    for (const auto& point : mesh.rest.rowwise()) largest = std::max(largest, exact(point.transpose()).norm());
    return {.problem = "patch_test",
            .quantity = {"nodal_error_from_" + data, "largest nodal error over largest displacement, from " + data},
            .elements = elements_of(problem.element_order),
            .material = linear_material(material.poisson),
            .mesh = text_of({n, n, n}) + " jittered",
            .h_m = 1.0 / n,
            .dofs = solution.space->dofs(),
            .value = solution.largest_nodal_error(exact) / largest,
            .unit = "1",
            .source = "closed form: an affine displacement is its own finite element solution",
            .low = 0.0,
            .high = rounding_bound(spectrum(solution, material)),
            .bound_from = rounding_bound_text};
}

}  // namespace

VerificationRows patch_test_rows(const Effort& effort)
{
    VerificationRows rows;
    for (const int element_order : {1, 2}) {
        rows.push_back(row_of(effort, "displacements", from_displacements(element_order), affine));
        rows.push_back(row_of(effort, "tractions", from_tractions(element_order), stretched));
    }
    return rows;
}

}  // namespace reference_fem
