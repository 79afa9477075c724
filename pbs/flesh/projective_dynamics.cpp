#include "pbs/flesh/projective_dynamics.hpp"

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/geometry/nearest_rotation.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pbs {

template <typename Scalar>
ProjectiveDynamics<Scalar>::ProjectiveDynamics(const TetMesh& mesh, const ProjectiveEnergy& energy,
                                               const CholeskyFactor& factor, const ProjectiveOptions& options)
    : options_(options),
      system_(make_flesh_system<Scalar>(mesh, energy, factor, options.packed, options.threads)),
      x_(system_->rows()),
      step_(x_)
{
}

template <typename Scalar>
ProjectiveSummary ProjectiveDynamics<Scalar>::minimise(const Positions& centres, Positions& x)
{
    ProjectiveSummary summary;
    system_->set_centres(centres);
    system_->load(x, x_);
    for (; summary.iterations < options_.iterations && !summary.converged; ++summary.iterations) {
        summary.energies.push_back(system_->value_and_gradient(x_, step_));
        system_->precondition(step_);
        system_->add(-1.0, step_, x_);
        summary.steps.push_back(std::sqrt(system_->dot(step_, step_)));
        if (!std::isfinite(summary.steps.back())) break;
        const double smallest = system_->smallest_step(x_, options_.stop_step, summary.steps.front());
        summary.converged = options_.stop_step > 0.0 && summary.steps.back() <= smallest;
    }
    system_->store(x_, x);
    return summary;
}

template class ProjectiveDynamics<float>;
template class ProjectiveDynamics<double>;

ProjectiveWeights projective_weights(double poisson, bool keeps_volume)
{
    const FleshMaterial material = flesh_material(poisson);
    const double lame = material.lambda - material.mu;
    return {2.0 * material.mu, keeps_volume ? 3.0 * lame : 0.0};
}

// |F|^2 has the factor (mu + share lambda) / 2 there, and (2 mu + 3 lambda_Lame) / 2 here.
double volume_share_of_projective(double poisson, bool keeps_volume)
{
    const FleshMaterial material = flesh_material(poisson);
    const ProjectiveWeights weights = projective_weights(poisson, keeps_volume);
    return (weights.strain + weights.volume - material.mu) / material.lambda;
}

ProjectiveForces projective_forces(const ProjectiveTet& tet, const ProjectiveWeights& weights,
                                   const Eigen::Matrix3d& edges)
{
    const Eigen::Matrix3d f = edges * tet.inverse_edges;
    const LocalShapes local = local_shapes(f);
    const Eigen::Matrix3d strain = f - local.rotation, volume = f - local.unit_volume;
    return {0.5 * tet.volume * (weights.strain * strain.squaredNorm() + weights.volume * volume.squaredNorm()),
            tet.volume * (weights.strain * strain + weights.volume * volume) * tet.inverse_edges.transpose()};
}

ProjectiveEnergy::ProjectiveEnergy(const TetMesh& mesh, const ProjectiveWeights& weights, const BoneHold& hold)
    : weights_(weights), hold_(hold.stiffness())
{
    positive_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        ProjectiveTet tet{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, {}, 0.0, {}};
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k)
            edges.col(k) = (mesh.rest.row(tet.vertex[k + 1]) - mesh.rest.row(tet.vertex[0])).transpose();
        tet.volume = sliver_factor(mesh, t) * edges.determinant() / 6.0;
        tet.inverse_edges = edges.inverse();
        for (int e = 0; e < 6; ++e) tet.w[e] = hold.edge_stiffness()(t, e);
        tets_.push_back(tet);
    }
}

double ProjectiveEnergy::value_and_gradient(const Positions& x, const Positions& centres, Positions& gradient) const
{
    const Positions from_centre = x - centres;
    gradient = hold_.asDiagonal() * from_centre;
    double value = 0.5 * gradient.cwiseProduct(from_centre).sum();
    for (const ProjectiveTet& tet : tets_) {
        Eigen::Matrix<double, 3, 4> corners, forces;
        for (int k = 0; k < 4; ++k) corners.col(k) = x.row(tet.vertex[k]).transpose();
        const ProjectiveForces of_tet =
            projective_forces(tet, weights_, corners.rightCols<3>().colwise() - corners.col(0));
        value += of_tet.value;
        forces.rightCols<3>() = of_tet.columns;
        forces.col(0) = -of_tet.columns.rowwise().sum();
        for (int e = 0; e < 6; ++e) {
            const auto [i, j] = edges_of_tet[e];
            const Vec3 edge = corners.col(i) - corners.col(j);
            value += 0.5 * tet.w[e] * edge.squaredNorm();
            forces.col(i) += tet.w[e] * edge;
            forces.col(j) -= tet.w[e] * edge;
        }
        for (int k = 0; k < 4; ++k) gradient.row(tet.vertex[k]) += forces.col(k).transpose();
    }
    return value;
}

namespace {

// The larger root y of y^2 - s y + kappa = 0, without cancellation where s < 0.
double larger_root(double s, double kappa)
{
    const double root = std::sqrt(std::max(s * s - 4.0 * kappa, 0.0));
    if (s >= 0.0) return 0.5 * (s + root);
    return root > s ? -2.0 * kappa / (root - s) : 0.0;
}

}  // namespace

// The smallest number's result y determines kappa = y (s_3 - y), and the others are the larger roots. y (their product)
// grows with y where it passes one for the first time below s_3, or above it.
Vec3 nearest_unit_product(const Vec3& s)
{
    const auto at = [&](double y) {
        const double kappa = y * (s(2) - y);
        return Vec3(larger_root(s(0), kappa), larger_root(s(1), kappa), y);
    };
    double low = std::max(s(2), 0.0), high = low;
    if (at(low).prod() < 1.0) {  // volume must grow: y > s_3
        high = std::max(2.0 * low, 1.0);
        while (at(high).prod() < 1.0) {
            low = high;
            high *= 2.0;
        }
    } else {
        low = 0.5 * high;
        while (at(low).prod() > 1.0) {
            high = low;
            low *= 0.5;
        }
    }
    double y = high;
    for (int step = 0; step < 100; ++step) {
        const Vec3 now = at(y);
        const double excess = now.prod() - 1.0, change = s(2) - 2.0 * y;  // d kappa / dy
        (excess < 0.0 ? low : high) = y;
        // The larger root r of r^2 - s r + kappa = 0 changes by -1 / (2 r - s) with kappa.
        const double slope =
            now(0) * now(1) - y * change * (now(1) / (2.0 * now(0) - s(0)) + now(0) / (2.0 * now(1) - s(1)));
        double next = y - excess / slope;                                   // Newton's method between
        if (!(next > low && next < high)) next = low + 0.5 * (high - low);  // bounds
        if (std::abs(next - y) <= std::numeric_limits<double>::epsilon() * y) break;
        y = next;
    }
    return at(y);
}

LocalShapes local_shapes(const Eigen::Matrix3d& f)
{
    LocalShapes result;
    result.rotation = nearest_rotation(f);
    if (!result.rotation.allFinite()) return {result.rotation, result.rotation};
    const Eigen::Matrix3d stretch = result.rotation.transpose() * f;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (stretch + stretch.transpose()));
    // the smallest last; the one of a reflection is the smallest in magnitude, too
    const Vec3 s = eigen.eigenvalues().reverse();
    const Eigen::Matrix3d axes = eigen.eigenvectors().rowwise().reverse();
    result.unit_volume = result.rotation * axes * nearest_unit_product(s).asDiagonal() * axes.transpose();
    return result;
}

}  // namespace pbs
