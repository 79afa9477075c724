#include "experiments/studies/verification/manufactured_attachment.hpp"

#include "pbs/character/bone_capsules.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/potentials/potentials.hpp"

namespace experiments {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;

namespace {

constexpr double spring_factor = 100.0, amplitude = 0.1;
const pbs::BoneCapsule capsule{{0.1, 0.5, 0.5}, {0.9, 0.5, 0.5}, 0.35, ""};
const Vec3 phase(0.3, 1.1, -0.4);
const Eigen::Matrix3d wave_vectors = (Eigen::Matrix3d() << 1.7, 0.9, -0.6, -0.8, 1.4, 1.1, 0.5, -1.2, 1.6).finished();  // row i: a_i

Vec3 exact(const Vec3& x)
{
    return amplitude * (wave_vectors * x + phase).array().sin();
}

Eigen::Matrix3d exact_gradient(const Vec3& x)
{
    return amplitude * (wave_vectors * x + phase).array().cos().matrix().asDiagonal() * wave_vectors;
}

double density(const Vec3& x)
{
    return spring_factor * manufactured_material.young_pa / (capsule.radius_m * capsule.radius_m) *
           pbs::smooth_density(capsule, pbs::AttachmentKernel::biweight, 1.0, x);
}

Lame lame(const ElasticMaterial& material)
{
    return lame_parameters(material.young_pa, material.poisson);
}

// -div P - k c, where (div P)_i = sum_jkl dP_ij / dF_kl u_k,lj and u_k,lj = -A sin(a_k . x + phi_k) a_kl a_kj.
Vec3 body_force(const Vec3& x, const Vec3& offset)
{
    static const auto law = constitutive_law(Model::stable_neo_hookean, lame(manufactured_material));
    const Tangent slope = tangent(law->evaluate(Eigen::Matrix3d::Identity() + exact_gradient(x), Derivatives::second), law->lambda_pa());
    const Vec3 minus_sine = -exact(x);
    Vec3 divergence = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l)
                    divergence(i) += slope(3 * j + i, 3 * l + k) * minus_sine(k) * wave_vectors(k, l) * wave_vectors(k, j);
    return -divergence - density(x) * offset;
}

struct Springs {
    Positions points, targets;
    Eigen::VectorXd stiffness;
};

Springs springs_of_bone(const ManufacturedSprings& of)
{
    constexpr int samples = 3;  // their error is a ninth of the default's
    Springs springs{pbs::sample_points(capsule, samples), {}, {}};
    springs.targets = springs.points;
    springs.stiffness.resize(springs.points.rows());
    for (Eigen::Index s = 0; s < springs.points.rows(); ++s) {
        const Vec3 point = springs.points.row(s);
        springs.targets.row(s) = (point + exact(point) + of.offset_m).transpose();
        springs.stiffness(s) = of.weight * density(point) * capsule.volume_m3() / static_cast<double>(springs.points.rows());
    }
    return springs;
}

// The exact values at the nodes on the surface of the cube are prescribed.
struct Prescribed {
    Eigen::VectorXd values;
    std::vector<bool> dofs;
};

Prescribed prescribed_on_surface(const SimplexSpace& space)
{
    Prescribed prescribed{Eigen::VectorXd(space.dofs()), std::vector<bool>(space.dofs(), false)};
    for (int node = 0; node < space.nodes(); ++node) {
        const Vec3 at = space.node_positions().row(node);
        prescribed.values.segment<3>(3 * node) = exact(at);
        const bool on_surface = at.minCoeff() < 1e-12 || at.maxCoeff() > 1.0 - 1e-12;
        for (int c = 0; c < 3; ++c) prescribed.dofs[3 * node + c] = on_surface;
    }
    return prescribed;
}

}  // namespace

AttachedSolution solve_manufactured(const pbs::TetMesh& mesh, int element_order, const ManufacturedSprings& of,
                                    const ElasticMaterial& material)
{
    const Springs springs = springs_of_bone(of);
    const SimplexSpace space(mesh, element_order);
    const ElasticPotential flesh(space, Model::stable_neo_hookean, lame(material), Formulation::displacement);
    const AttachedPoints points(mesh, space, springs.points, springs.stiffness);
    SpringPotential held(points);
    held.move_to(springs.targets);
    const DeadLoad load(load_vector(space, [&](const Vec3& x) { return body_force(x, of.offset_m); }));

    const Prescribed prescribed = prescribed_on_surface(space);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    NewtonMinimiser newton(space, prescribed.dofs, LinearSolver::cholmod);
    const bool converged = newton.minimise({&flesh, &held, &load}, prescribed.values, displacement, {}).converged();

    const double error = error_norms(space, displacement, exact, exact_gradient).l2;
    const double whole = error_norms(space, Eigen::VectorXd::Zero(space.dofs()), exact, exact_gradient).l2;
    return {mesh.rest + Eigen::Map<const Positions>(displacement.data(), mesh.rest.rows(), 3), error / whole, space.dofs(), converged};
}

Positions exact_positions(const Positions& rest)
{
    Positions positions = rest;
    for (auto row : positions.rowwise()) row += exact(row.transpose()).transpose();
    return positions;
}

}  // namespace experiments
