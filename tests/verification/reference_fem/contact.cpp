// Reference: a rigid plane. A bar with a notch, which is its own mirror image, is bent until the notch closes. Its
// halves press on each other as each of them presses on a plane through the middle, so that contact of the flesh with
// itself can be replaced by an obstacle that knows nothing of pairs. A gap d of the halves is d / 2 to the plane: with
// half the range, the barrier has the same pressure and the same energy. (The law itself is tested against its closed
// form on flat faces, in the unit tests of the potential.)
#include "reference_fem/contact/contact_potential.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/verification/problems.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace reference_fem;
using pbs::Vec3;

constexpr double young_pa = 1e5, range_m = 4e-3, root_m = 1.0 / 3.0,
                 turn_of_an_end_rad = 35.0 / 180.0 * std::numbers::pi;

// The plane x = 0 as an obstacle: nodes of the right half are kept at x > 0, those of the left half at x < 0. Below a
// fifth of the range the barrier goes on as its Taylor polynomial of degree two, so that a first step may go through
// the plane.
class MiddlePlane : public Potential {
public:
    MiddlePlane(const SimplexSpace& space, const ContactOptions& options)
        : options_(options), rest_(space.node_positions()), area_(contact_surface(space).node_area)
    {
        for (int n = 0; n < space.nodes(); ++n)
            // the section below the notch, where the halves are joined
            if (std::abs(rest_(n, 0)) < 1e-9) area_(n) = 0.0;
    }

    double value(const Eigen::VectorXd& displacement) const override
    {
        double energy_j = 0.0;
        for (int n = 0; n < area_.size(); ++n) energy_j += options_.stiffness_pa * area_(n) * at(displacement, n).value;
        return energy_j;
    }
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override
    {
        for (int n = 0; n < area_.size(); ++n)
            gradient(3 * n) += side(n) * options_.stiffness_pa * area_(n) * at(displacement, n).first;
    }
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness, NodalMatrix& hessian) const override
    {
        for (int n = 0; n < area_.size(); ++n) {
            Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
            block(0, 0) = options_.stiffness_pa * area_(n) * at(displacement, n).second;
            hessian.add_block(n, n, block);
        }
    }
    bool is_quadratic() const override { return false; }

private:
    double side(int node) const { return rest_(node, 0) > 0.0 ? 1.0 : -1.0; }

    Barrier at(const Eigen::VectorXd& displacement, int node) const
    {
        const double distance_m = side(node) * (rest_(node, 0) + displacement(3 * node)),
                     from_m = 0.2 * options_.range_m;
        if (distance_m >= from_m) return barrier(distance_m, options_.range_m);
        const Barrier b = barrier(from_m, options_.range_m);
        const double way_m = distance_m - from_m;
        return {b.value + b.first * way_m + b.second / 2.0 * way_m * way_m, b.first + b.second * way_m, b.second};
    }

    ContactOptions options_;
    pbs::Positions rest_;
    Eigen::VectorXd area_;
};

// 2 m long, 1 m high, with a notch of 60 degrees from above down to a third of the height.
pbs::TetMesh notched_bar()
{
    const pbs::TetMesh half = mapped(box_mesh({0, 0, 0}, {1, 1, 0.4}, {4, 6, 2}), [](const Vec3& p) {
        return Vec3(p.x() + std::tan(std::numbers::pi / 6.0) * std::max(0.0, p.y() - root_m) * (1.0 - p.x()), p.y(),
                    p.z());
    });
    return joined({half, mapped(half, [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); })});
}

// Each half turned as a rigid body about the root of the notch.
Eigen::VectorXd turned(const SimplexSpace& space, double angle_rad)
{
    Eigen::VectorXd displacement(space.dofs());
    for (int n = 0; n < space.nodes(); ++n) {
        const Vec3 arm = space.node_positions().row(n).transpose() - Vec3(0.0, root_m, 0.0);
        displacement.segment<3>(3 * n) =
            Eigen::AngleAxisd(arm.x() > 0.0 ? angle_rad : -angle_rad, Vec3::UnitZ()) * arm - arm;
    }
    return displacement;
}

// The notch of 60 degrees is closed by 70 degrees between the ends. Empty: not reached.
Eigen::VectorXd bent(const SimplexSpace& space, const Potential* contact)
{
    const ElasticPotential flesh(space, Model::neo_hookean, lame_parameters(young_pa, 0.3), Formulation::displacement);
    std::vector<bool> held(space.dofs(), false);
    for (int n = 0; n < space.nodes(); ++n)
        if (std::abs(space.node_positions()(n, 0)) > 1.0 - 1e-9) std::fill_n(held.begin() + 3 * n, 3, true);
    Terms terms = {&flesh};
    if (contact) terms.push_back(contact);
    NewtonMinimiser newton(space, held, LinearSolver::cholmod);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    const LoadPathSummary path = follow_load_path(
        [&](double fraction) {
            return newton.minimise(terms, turned(space, fraction * turn_of_an_end_rad), displacement, {});
        },
        displacement, {.first_step = 0.125});
    return path.converged() ? displacement : Eigen::VectorXd();
}

// The largest difference of two displacements across the plane [m].
double farthest_across(const Eigen::VectorXd& one, const Eigen::VectorXd& other)
{
    return (one - other)(Eigen::seq(0, Eigen::last, 3)).cwiseAbs().maxCoeff();
}

class ClosedNotch : public testing::TestWithParam<int> {};

// The pressed nodes of both solutions lie between the plane and half the range from it, so that they differ across it
// by less than that. That the rest of the body differs by no more is measured, not derived. Along the plane the rims of
// the halves are free to slide.
TEST_P(ClosedNotch, IsThatOfTwoHalvesThatPressOnARigidPlane)
{
    const SimplexSpace space(notched_bar(), GetParam());
    const ContactPotential itself(space, {.range_m = range_m, .stiffness_pa = young_pa});
    const MiddlePlane plane(space, {.range_m = range_m / 2.0, .stiffness_pa = young_pa});
    const Eigen::VectorXd on_itself = bent(space, &itself), on_plane = bent(space, &plane),
                          without = bent(space, nullptr);
    ASSERT_TRUE(on_itself.size() > 0 && on_plane.size() > 0 && without.size() > 0);
    EXPECT_LT(farthest_across(on_itself, on_plane), range_m / 2.0);
    EXPECT_GT(farthest_across(without, on_plane), 10.0 * range_m)
        << "without contact the halves pass through each other";
}

INSTANTIATE_TEST_SUITE_P(Elements, ClosedNotch, testing::Values(1, 2), testing::PrintToStringParamName());

}  // namespace
