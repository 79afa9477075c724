// The reference as a deformer, on a coarse limb whose forearm turns: properties that do not depend on the flesh.
//   Young's modulus cancels where displacements alone drive the body. A pose that turns the whole limb does not change
//   its shape, however the bones hold it. A further frame of the linear reference costs one re-solve.

#include "experiments/characters/bone_capsules.hpp"
#include "experiments/deformers/fem/fem_deformers.hpp"
#include "experiments/studies/verification/problem.hpp"
#include "pbs/geometry/cost.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/potentials/potentials.hpp"
#include "reference_fem/verification/problems.hpp"

#include <algorithm>
#include <numbers>

namespace experiments {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;

namespace {

constexpr int coarse = 500;  // vertices
const FemOptions limb_flesh = {.model = reference_fem::Model::neo_hookean, .element_order = 1};

pbs::Pose twisted(const pbs::Character& limb, double angle_deg)
{
    return pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitX(), angle_deg, 2, 0.01).steps.back();
}

pbs::Pose turned_whole(const pbs::Character& limb, double angle_deg)
{
    const Eigen::AngleAxisd turn(angle_deg * std::numbers::pi / 180.0, pbs::Vec3(1, 2, 3).normalized());
    return pbs::Pose(limb.skeleton.bones.size(), Eigen::Isometry3d(turn));
}

// The values are not a number where the pose is not reached.
pbs::Positions shape(const pbs::Character& limb, const FemOptions& options, const pbs::Pose& pose)
{
    ElasticFemDeformer deformer(options);
    deformer.reset(limb);
    if (deformer.advance(pose, 0.01).outcome == pbs::Outcome::finished) return deformer.positions();
    return pbs::Positions::Constant(limb.mesh.rest.rows(), 3, not_reached);
}

// Root mean square distance over that of `to` from rest.
double distance(const pbs::Character& limb, const pbs::Positions& positions, const pbs::Positions& to)
{
    return (positions - to).norm() / (to - limb.mesh.rest).norm();
}

VerificationRow row_of(const pbs::Character& limb, const RowQuantity& quantity, double value, double reference,
                       double tolerance, const std::string& from)
{
    VerificationRow row = row_about({"attached_limb", elements_of(1), material_of("neo_hookean", 0.45),
                                     "limb, " + std::to_string(limb.mesh.rest.rows()) + " vertices", 0.0,
                                     static_cast<int>(3 * limb.mesh.rest.rows())},
                                    quantity, value, reference, "1", "closed form: theory of elasticity");
    bound(row, reference - tolerance, reference + tolerance, from);
    return row;
}

VerificationRow young_cancels(const pbs::Character& limb)
{
    FemOptions soft = limb_flesh, hard = limb_flesh;
    soft.young_pa = 1e3;
    hard.young_pa = 1e7;
    const pbs::Pose pose = twisted(limb, 40.0);

    return row_of(
        limb, {"shape_change_with_young", "change of the shape with Young's modulus, 1e3 to 1e7 Pa"},
        distance(limb, shape(limb, soft, pose), shape(limb, hard, pose)), 0.0, 1e-6,
        "every force scales with Young's modulus; Newton stops at 1e-8 of them, 1e-6 leaves a condition of 100");
}

VerificationRow rigid_motion(const pbs::Character& limb, FemAttachment attachment, const std::string& name)
{
    FemOptions options = limb_flesh;
    options.attachment = attachment;
    const pbs::Pose pose = turned_whole(limb, 120.0);
    pbs::Positions turned = limb.mesh.rest;
    for (auto row : turned.rowwise()) row = (pose.front() * pbs::Vec3(row.transpose())).transpose();
    return row_of(
        limb, {"distance_from_rigid_turn", "distance from a rigid turn of 120 degrees, bones hold by " + name, name},
        distance(limb, shape(limb, options, pose), turned), 0.0, 1e-9,
        "rounding of positions, eps, times at most some 1e6 of condition");
}

VerificationRow kept_factor(const pbs::Character& limb)
{
    LinearFemDeformer deformer(FemOptions{});
    const pbs::Stopwatch first;
    deformer.reset(limb);
    deformer.advance(twisted(limb, 1.0), 0.01);
    const double first_s = first.seconds();
    std::vector<double> later_s;
    for (int frame = 2; frame <= 8; ++frame) later_s.push_back(deformer.advance(twisted(limb, frame), 0.01).seconds);
    std::nth_element(later_s.begin(), later_s.begin() + 3, later_s.end());
    VerificationRow row =
        row_of(limb, {"time_of_further_frame", "time of a further frame over that of the first, set-up included"},
               later_s[3] / first_s, 0.0, 0.0, "");
    unbound(row);
    row.elements = elements_of(2);
    row.material = linear_material(0.45);
    row.source = "none: a cost of this run; at most 1/50 is wanted of a factor that is kept";
    return row;
}

constexpr double spring_factor = 100.0, amplitude = 0.1;
const pbs::BoneCapsule capsule{{0.1, 0.5, 0.5}, {0.9, 0.5, 0.5}, 0.35, ""};
const Vec3 phase(0.3, 1.1, -0.4);
// row i: a_i
const Eigen::Matrix3d wave_vectors = (Eigen::Matrix3d() << 1.7, 0.9, -0.6, -0.8, 1.4, 1.1, 0.5, -1.2, 1.6).finished();

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
    const Tangent slope =
        tangent(law->evaluate(Eigen::Matrix3d::Identity() + exact_gradient(x), Derivatives::second), law->lambda_pa());
    const Vec3 minus_sine = -exact(x);
    Vec3 divergence = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l)
                    divergence(i) +=
                        slope(3 * j + i, 3 * l + k) * minus_sine(k) * wave_vectors(k, l) * wave_vectors(k, j);
    return -divergence - density(x) * offset;
}

struct Springs {
    Positions points, targets;
    Eigen::VectorXd stiffness;
};

Springs springs_of_bone(const ManufacturedSprings& manufactured_springs)
{
    constexpr int samples = 3;  // their error is a ninth of the default's
    Springs springs{pbs::sample_points(capsule, samples), {}, {}};
    springs.targets = springs.points;
    springs.stiffness.resize(springs.points.rows());
    for (Eigen::Index s = 0; s < springs.points.rows(); ++s) {
        const Vec3 point = springs.points.row(s);
        springs.targets.row(s) = (point + exact(point) + manufactured_springs.offset_m).transpose();
        springs.stiffness(s) = manufactured_springs.weight * density(point) * capsule.volume_m3() /
                               static_cast<double>(springs.points.rows());
    }
    return springs;
}

}  // namespace

VerificationRows attached_limb_rows(const Effort& effort)
{
    if (!effort.limb) return {};
    const pbs::Character limb = effort.limb(coarse);
    return {young_cancels(limb), rigid_motion(limb, FemAttachment::smooth, "smooth"),
            rigid_motion(limb, FemAttachment::embedded, "embedded"), rigid_motion(limb, FemAttachment::bind, "bind"),
            kept_factor(effort.limb(0))};
}

AttachedSolution solve_manufactured(const pbs::TetMesh& mesh, int element_order,
                                    const ManufacturedSprings& manufactured_springs, const ElasticMaterial& material)
{
    const Springs springs = springs_of_bone(manufactured_springs);
    const SimplexSpace space(mesh, element_order);
    const ElasticPotential flesh(space, Model::stable_neo_hookean, lame(material), Formulation::displacement);
    const AttachedPoints points(mesh, space, springs.points, springs.stiffness);
    SpringPotential held(points);
    held.move_to(springs.targets);
    const DeadLoad load(
        load_vector(space, [&](const Vec3& x) { return body_force(x, manufactured_springs.offset_m); }));

    const PrescribedData prescribed = prescribed_data(space, {.displacement = exact});
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    NewtonMinimiser newton(space, prescribed.held, LinearSolver::cholmod);
    const bool converged = newton.minimise({&flesh, &held, &load}, prescribed.values, displacement, {}).converged();

    const double error = error_norms(space, displacement, exact, exact_gradient).l2;
    const double whole = error_norms(space, Eigen::VectorXd::Zero(space.dofs()), exact, exact_gradient).l2;
    return {mesh.rest + Eigen::Map<const Positions>(displacement.data(), mesh.rest.rows(), 3), error / whole,
            space.dofs(), converged};
}

Positions exact_positions(const Positions& rest)
{
    Positions positions = rest;
    for (auto row : positions.rowwise()) row += exact(row.transpose()).transpose();
    return positions;
}

}  // namespace experiments
