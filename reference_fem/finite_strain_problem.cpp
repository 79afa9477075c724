#include "reference_fem/finite_strain_problem.hpp"

#include "reference_fem/potentials/dead_load.hpp"
#include "reference_fem/potentials/elastic_potential.hpp"

namespace reference_fem {

FiniteStrainSolution solve_at_finite_strain(const pbs::TetMesh& mesh, const ElasticMaterial& material, Model model,
                                            const BoundaryValueProblem& problem, const LoadPathOptions& path)
{
    FiniteStrainSolution solution{std::make_shared<const SimplexSpace>(mesh, problem.element_order), {}, {}};
    const SimplexSpace& space = *solution.space;
    solution.displacement.setZero(space.dofs());
    const ElasticPotential flesh(space, model, lame_parameters(material.young_pa, material.poisson), problem.formulation);
    const PrescribedData prescribed = prescribed_data(space, problem);
    const Eigen::VectorXd whole_load = external_load(space, problem);
    DeadLoad load(Eigen::VectorXd::Zero(space.dofs()));
    NewtonMinimiser newton(space, prescribed.held, problem.solver);
    solution.path = follow_load_path(
        [&](double fraction) {
            load.set(fraction * whole_load);
            return newton.minimise({&flesh, &load}, fraction * prescribed.values, solution.displacement, {});
        },
        solution.displacement, path);
    return solution;
}

pbs::Vec3 FiniteStrainSolution::displacement_at(const pbs::Vec3& point) const
{
    return displacement.segment<3>(3 * nearest_node(*space, point));
}

}  // namespace reference_fem
