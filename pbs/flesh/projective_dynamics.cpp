#include "pbs/flesh/projective_dynamics.hpp"

#include "pbs/flesh/rows.hpp"
#include "pbs/flesh/triangular_solve.hpp"
#include "pbs/flesh/volume_projection.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/number_text.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pbs {
namespace {

constexpr int ends_of_edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

void check_poisson_of_projective(double poisson)
{
    if (poisson >= 0.0 && poisson < 0.5) return;
    throw InputError("projective_dynamics", 0, "poisson", number_text(poisson), "expected 0 <= poisson < 0.5");
}

// Sum of h |x_i - x_j|^2 / 2 and a |x_i|^2 / 2.
class LowerTriangle {
public:
    explicit LowerTriangle(Eigen::VectorXd diagonal) : diagonal_(std::move(diagonal)) {}

    void add_edge(int i, int j, double h)
    {
        entries_.emplace_back(std::max(i, j), std::min(i, j), -h);
        diagonal_(i) += h;
        diagonal_(j) += h;
    }

    // A vertex without tets stays where it is, and a part that nothing holds keeps its mean.
    Eigen::SparseMatrix<double> matrix()
    {
        constexpr double regular = 1e-9;
        for (Eigen::Index i = 0; i < diagonal_.size(); ++i)
            entries_.emplace_back(i, i, diagonal_(i) > 0.0 ? (1.0 + regular) * diagonal_(i) : 1.0);
        Eigen::SparseMatrix<double> result(diagonal_.size(), diagonal_.size());
        result.setFromTriplets(entries_.begin(), entries_.end());
        return result;
    }

private:
    Eigen::VectorXd diagonal_;
    std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

ProjectiveDynamics::ProjectiveDynamics(const TetMesh& mesh, const BoneHold& hold, const ProjectiveOptions& options)
    : hold_(&hold), options_(options), place_(mesh.rest.rows())
{
    check_poisson_of_projective(options.poisson);
    strain_weight_ = 2.0 * (1.0 / (2.0 * (1.0 + options.poisson)));
    volume_weight_ = options.keeps_volume ? 3.0 * options.poisson / ((1.0 + options.poisson) * (1.0 - 2.0 * options.poisson)) : 0.0;
    LowerTriangle triangle(hold.stiffness());
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        Tet tet{mesh.tets.row(t).transpose(), {}, 0.0};
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) edges.row(k) = mesh.rest.row(tet.vertex(k + 1)) - mesh.rest.row(tet.vertex(0));
        tet.volume = edges.determinant() / 6.0;
        if (!(tet.volume > 0.0))
            throw InputError("projective_dynamics", 0, "tet " + std::to_string(t), number_text(tet.volume), "expected a positive volume");
        tet.gradients.rightCols<3>() = edges.inverse();
        tet.gradients.col(0) = -tet.gradients.rightCols<3>().rowwise().sum();
        for (int e = 0; e < 6; ++e) {
            const auto [i, j] = ends_of_edge[e];
            const double h = -(strain_weight_ + volume_weight_) * tet.volume * tet.gradients.col(i).dot(tet.gradients.col(j));
            triangle.add_edge(tet.vertex(i), tet.vertex(j), h + hold.edge_stiffness()(t, e));
        }
        tets_.push_back(tet);
    }
    matrix_ = triangle.matrix();
    factor_ = cholesky_factor(matrix_);
    if (!factor_.usable()) throw InputError("projective_dynamics", 0, "mesh", "", "expected tets whose matrix is positive definite");
    std::iota(place_.begin(), place_.end(), 0);
}

double ProjectiveDynamics::value_and_gradient(const Positions& x, const Positions& centres, Positions& gradient) const
{
    const Positions from_centre = x - centres;
    gradient = hold_->stiffness().asDiagonal() * from_centre;
    double value = 0.5 * gradient.cwiseProduct(from_centre).sum();
    for (std::size_t t = 0; t < tets_.size(); ++t) {
        const Tet& tet = tets_[t];
        Eigen::Matrix<double, 3, 4> corners;
        for (int k = 0; k < 4; ++k) corners.col(k) = x.row(tet.vertex(k)).transpose();
        const Eigen::Matrix3d f = corners * tet.gradients.transpose();
        const LocalShapes local = local_shapes(f);
        const Eigen::Matrix3d strain = f - local.rotation, volume = f - local.unit_volume;
        value += 0.5 * tet.volume * (strain_weight_ * strain.squaredNorm() + volume_weight_ * volume.squaredNorm());
        Eigen::Matrix<double, 3, 4> forces = tet.volume * (strain_weight_ * strain + volume_weight_ * volume) * tet.gradients;
        for (int e = 0; e < 6; ++e) {
            const auto [i, j] = ends_of_edge[e];
            const Vec3 edge = corners.col(i) - corners.col(j);
            const double h = hold_->edge_stiffness()(static_cast<Eigen::Index>(t), e);
            value += 0.5 * h * edge.squaredNorm();
            forces.col(i) += h * edge;
            forces.col(j) -= h * edge;
        }
        for (int k = 0; k < 4; ++k) gradient.row(tet.vertex(k)) += forces.col(k).transpose();
    }
    return value;
}

ProjectiveSummary ProjectiveDynamics::minimise(const Positions& centres, Positions& x)
{
    ProjectiveSummary summary;
    Positions gradient;
    Rows<double> step(static_cast<int>(x.rows()));
    for (; summary.iterations < options_.iterations && !summary.converged; ++summary.iterations) {
        summary.energies.push_back(value_and_gradient(x, centres, gradient));
        for (Eigen::Index i = 0; i < x.rows(); ++i)
            for (int axis = 0; axis < 3; ++axis) step[static_cast<int>(i)][axis] = gradient(i, axis);
        solve_plainly(factor_, place_, step.data(), work_);
        double squares = 0.0;
        for (Eigen::Index i = 0; i < x.rows(); ++i)
            for (int axis = 0; axis < 3; ++axis) {
                const double change = step[static_cast<int>(i)][axis];
                x(i, axis) -= change;
                squares += change * change;
            }
        summary.steps.push_back(std::sqrt(squares));
        if (!std::isfinite(squares)) break;
        summary.converged = summary.steps.back() <= options_.stop_step * summary.steps.front();
    }
    return summary;
}

}  // namespace pbs
