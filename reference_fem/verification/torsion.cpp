// A square bar whose ends turn against each other, free to warp: Saint-Venant's torsion is then the exact solution in three dimensions.
// Torque = G J theta / L, J = s^4 / 3 (1 - 192 / pi^5 sum over odd n of tanh(n pi / 2) / n^5) (Timoshenko and Goodier, Theory of
// elasticity, art. 109). The data are displacements, so the strain energy, hence the torque, comes from above, with twice the order of
// the displacement gradient.
#include "reference_fem/verification/beam_problems.hpp"

#include <cmath>
#include <numbers>

namespace reference_fem {
namespace {

using pbs::Vec3;

constexpr double length_m = 1.0, side_m = 1.0, angle = 1.0e-3, young_pa = 1.0e5;

double torsion_constant()
{
    double sum = 0.0;
    for (int n = 1; n <= 201; n += 2) sum += std::tanh(n * std::numbers::pi / 2.0) / std::pow(n, 5);
    return std::pow(side_m, 4) / 3.0 * (1.0 - 192.0 / std::pow(std::numbers::pi, 5) * sum);
}

}  // namespace

VerificationRow torsion_row(const Effort& effort, double nu, int element_order, Formulation formulation, int n)
{
    const ElasticMaterial material{young_pa, nu};
    const auto turned = [](const Vec3& x) -> Vec3 { return angle * x.x() / length_m * Vec3(0.0, -x.z(), x.y()); };
    const auto held = [](const Vec3& x) {
        const bool at_end = x.x() < 1e-9 || x.x() > length_m - 1e-9;
        return Held(x.norm() < 1e-9, at_end, at_end);  // one point keeps the bar from sliding along its axis
    };
    const ElasticMaterial solved = solver_material(effort, material);
    const BoundaryValueSolution solution =
        solve(box_mesh({0, -side_m / 2.0, -side_m / 2.0}, {length_m, side_m / 2.0, side_m / 2.0}, {n, n, n}), solved,
              {.displacement = turned, .held = held, .element_order = element_order, .formulation = formulation});
    const double shear_pa = young_pa / (2.0 * (1.0 + nu));
    return {.problem = "torsion",
            .quantity = {"torque", "torque"},
            .elements = elements_of(element_order, formulation),
            .material = linear_material(nu),
            .mesh = text_of({n, n, n}),
            .h_m = side_m / n,
            .dofs = solution.space->dofs(),
            .value = 2.0 * solution.strain_energy_j(solved) / angle,
            .reference = shear_pa * torsion_constant() * angle / length_m,
            .unit = "N m",
            .source = "closed form: Saint-Venant's series (Timoshenko and Goodier, Theory of elasticity, art. 109)"};
}

namespace {

VerificationRows ladder(const Effort& effort, int element_order, int coarsest, int levels)
{
    VerificationRows rows;
    for (int level = 0; level < levels; ++level) {
        rows.push_back(torsion_row(effort, 0.3, element_order, Formulation::displacement, coarsest << level));
        if (level == 0) continue;
        const VerificationRow& coarser = rows[level - 1];
        rows.back().observed_order = order_between(coarser.value - coarser.reference, rows.back().value - rows.back().reference);
    }
    VerificationRow& finest = rows.back();
    finest.low = finest.reference * (1.0 - 1e-9);
    if (element_order == 1) {
        finest.expected_order = 2.0;
        finest.bound_from = "from above, as displacements are the data; order 2 of the energy within 0.1";
    } else {
        finest.high = finest.reference * (1.0 + grade_a);
        finest.bound_from = "from above, as displacements are the data; " + grade_a_text;
        finest.note = "the warping is as r^2 ln r at the edges, so the energy's order 4 is approached with the logarithm of h";
    }
    return rows;
}

}  // namespace

VerificationRows torsion_rows(const Effort& effort)
{
    VerificationRows rows = ladder(effort, 1, 4, effort.full ? 4 : 3);
    for (const auto& row : ladder(effort, 2, 2, effort.full ? 4 : 3)) rows.push_back(row);
    return rows;
}

}  // namespace reference_fem
