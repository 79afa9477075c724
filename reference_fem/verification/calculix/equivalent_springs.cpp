#include "reference_fem/verification/calculix/equivalent_springs.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace reference_fem {
namespace {

// Barycentric coordinates of points in each tet, from the inverse of the matrix of its corners.
class Barycentrics {
public:
    explicit Barycentrics(const NodalProblem& problem)
    {
        for (const auto& tet : problem.tets.rowwise()) {
            Eigen::Matrix4d corners;
            for (int i = 0; i < 4; ++i) corners.col(i) << 1.0, problem.nodes.row(tet(i)).transpose();
            of_point_.push_back(corners.inverse());
        }
    }

    // The tet in which the point lies deepest, and its coordinates there; tet -1: outside all.
    std::pair<int, Eigen::Vector4d> locate(const Eigen::RowVector3d& point) const
    {
        const Eigen::Vector4d homogeneous(1.0, point(0), point(1), point(2));
        double deepest = -1e-10;  // a point this far outside is on the face but for rounding
        std::pair<int, Eigen::Vector4d> found{-1, Eigen::Vector4d::Zero()};
        for (std::size_t t = 0; t < of_point_.size(); ++t) {
            const Eigen::Vector4d barycentric = of_point_[t] * homogeneous;
            if (barycentric.minCoeff() < deepest) continue;
            deepest = barycentric.minCoeff();
            found = {static_cast<int>(t), barycentric};
        }
        return found;
    }

private:
    std::vector<Eigen::Matrix4d> of_point_;
};

}  // namespace

Eigen::VectorXd tet_shape_functions(const Eigen::Vector4d& barycentric, int nodes_per_tet)
{
    if (nodes_per_tet == 4) return barycentric;
    Eigen::VectorXd shapes(10);
    shapes.head<4>() = barycentric.array() * (2.0 * barycentric.array() - 1.0);
    constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (int k = 0; k < 6; ++k) shapes(4 + k) = 4.0 * barycentric(edges[k][0]) * barycentric(edges[k][1]);
    return shapes;
}

EquivalentSprings equivalent_springs(const NodalProblem& problem)
{
    const GroundSprings& many = problem.springs;
    EquivalentSprings few;
    few.forces_n = pbs::Positions::Zero(problem.nodes.rows(), 3);
    const int width = static_cast<int>(problem.tets.cols());
    const Barycentrics barycentrics(problem);
    std::vector<Eigen::MatrixXd> of_tet(problem.tets.rows());
    for (Eigen::Index s = 0; s < many.points.rows(); ++s) {
        const auto [tet, barycentric] = barycentrics.locate(many.points.row(s));
        if (tet < 0) continue;
        const Eigen::VectorXd shapes = tet_shape_functions(barycentric, width);
        if (of_tet[tet].size() == 0) of_tet[tet] = Eigen::MatrixXd::Zero(width, width);
        of_tet[tet] += many.stiffness_n_m(s) * shapes * shapes.transpose();
        for (int i = 0; i < width; ++i)
            few.forces_n.row(problem.tets(tet, i)) += many.stiffness_n_m(s) * shapes(i) * (many.targets.row(s) - many.points.row(s));
    }

    for (std::size_t t = 0; t < of_tet.size(); ++t) {
        if (of_tet[t].size() == 0) continue;
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(of_tet[t]);
        for (int m = 0; m < width; ++m)
            if (eigen.eigenvalues()(m) > 0.0)
                few.springs.push_back({static_cast<int>(t), std::sqrt(eigen.eigenvalues()(m)) * eigen.eigenvectors().col(m)});
        few.stiffness_n_m = std::max(few.stiffness_n_m, eigen.eigenvalues().maxCoeff());
    }
    for (EquivalentSpring& spring : few.springs) spring.coefficients /= std::sqrt(few.stiffness_n_m);
    std::erase_if(few.springs, [](const EquivalentSpring& spring) {
        return spring.coefficients.squaredNorm() <= std::numeric_limits<double>::epsilon();
    });
    return few;
}

}  // namespace reference_fem
