// Reference: the projections of constraints/, one after the other in file order.
#include "pbs/solver/project_plain.hpp"
#include "pbs/solver/projection.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

namespace projection_tests {
namespace {

using pbs::Vec3;

class ProjectPlain : public testing::Test {
protected:
    ProjectPlain()
    {
        test_support::RandomPoints random(21);
        pbs::PbsOptions options;
        options.masses = pbs::Masses::lumped;
        const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});
        constraints =
            pbs::make_constraint_set<double>(bar, Eigen::VectorXd::Constant(bar.rest.rows(), 0.5), {}, options);
        for (Eigen::Index i = 0; i < bar.rest.rows(); ++i) {
            p.push_back(Vec3(bar.rest.row(i)) + random.point(0.2));
            q.push_back(Vec3(bar.rest(i, 0), 0.5, 0.5));
        }
    }

    pbs::ConstraintSet<double> constraints;
    std::vector<Vec3> p, q;
};

TEST_F(ProjectPlain, OneAfterTheOtherInFileOrder)
{
    const std::vector<double>& w = constraints.inverse_mass;
    std::vector<Vec3> expected = p;
    for (const auto& c : constraints.bind) project(c, w[c.vertex], q[c.vertex], expected[c.vertex]);
    pbs::project_bind_constraints(constraints, q, p);
    EXPECT_EQ(p, expected);
    for (const auto& c : constraints.stretch)
        project(c, w[c.vertex[0]], w[c.vertex[1]], expected[c.vertex[0]], expected[c.vertex[1]]);
    pbs::project_stretch_constraints(constraints, p);
    EXPECT_EQ(p, expected);
    for (const auto& c : constraints.volume)
        project(c, w[c.vertex[0]], w[c.vertex[1]], w[c.vertex[2]], w[c.vertex[3]], expected[c.vertex[0]],
                expected[c.vertex[1]], expected[c.vertex[2]], expected[c.vertex[3]]);
    pbs::project_volume_constraints(constraints, p);
    EXPECT_EQ(p, expected);
}

TEST_F(ProjectPlain, EmptyClassesMoveNothing)
{
    const std::vector<Vec3> before = p;
    const pbs::ConstraintSet<double> none;
    pbs::project_bind_constraints(none, q, p);
    pbs::project_stretch_constraints(none, p);
    pbs::project_volume_constraints(none, p);
    EXPECT_EQ(p, before);
}

// Reference: the classes projected by hand in the order that the class order states.

using pbs::ClassOrder;
using Plain = pbs::Projection<double>;
using Project = void (Plain::*)();

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
constexpr Project bind = &Plain::project_bind_constraints, stretch = &Plain::project_stretch_constraints,
                  volume = &Plain::project_volume_constraints;

std::unique_ptr<Plain> projection(ClassOrder class_order)
{
    pbs::PbsOptions options;
    options.order = pbs::Order::plain;
    options.class_order = class_order;
    auto made = pbs::make_projection(pbs::make_constraint_set<double>(limb.mesh, limb.binding.distance, {}, options),
                                     limb.mesh.tets, options);
    made->load(limb.lbs, limb.bind_points, pbs::Vec3::Zero());
    return made;
}

pbs::Positions after(Plain& projection, const std::array<Project, 3>& classes)
{
    for (int iteration = 0; iteration < 3; ++iteration)
        for (const Project project : classes) (projection.*project)();
    pbs::Positions positions = limb.lbs;
    projection.store(pbs::Vec3::Zero(), positions);
    return positions;
}

struct NamedOrder {
    ClassOrder order;
    std::array<Project, 3> classes;
};
const NamedOrder orders[] = {{ClassOrder::bind_stretch_volume, {bind, stretch, volume}},
                             {ClassOrder::bind_volume_stretch, {bind, volume, stretch}},
                             {ClassOrder::stretch_bind_volume, {stretch, bind, volume}},
                             {ClassOrder::stretch_volume_bind, {stretch, volume, bind}},
                             {ClassOrder::volume_bind_stretch, {volume, bind, stretch}},
                             {ClassOrder::volume_stretch_bind, {volume, stretch, bind}}};

TEST(ReorderedProjection, TakesTheClassesInTheOrderOfItsNameWhichMatters)
{
    const auto by_hand = projection(ClassOrder::bind_stretch_volume);
    const pbs::Positions first = after(*by_hand, orders[0].classes);
    for (const NamedOrder& named : orders) {
        by_hand->load(limb.lbs, limb.bind_points, pbs::Vec3::Zero());
        const pbs::Positions reordered = after(*projection(named.order), {bind, stretch, volume});
        EXPECT_EQ(reordered, after(*by_hand, named.classes)) << int(named.order);
        EXPECT_EQ(reordered == first, named.order == ClassOrder::bind_stretch_volume) << int(named.order);
    }
}

}  // namespace
}  // namespace projection_tests
