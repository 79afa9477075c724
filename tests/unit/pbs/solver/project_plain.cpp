// Reference: the projections of constraints/, one after the other in file order.
#include "pbs/solver/project_plain.hpp"

#include "tests/support/random_points.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

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
        constraints = pbs::make_constraint_set<double>(bar, Eigen::VectorXd::Constant(bar.rest.rows(), 0.5), {}, options);
        for (Eigen::Index i = 0; i < bar.rest.rows(); ++i) {
            p.push_back(Vec3(bar.rest.row(i)) + random.point(0.2));
            q.push_back(Vec3(bar.rest(i, 0), 0.5, 0.5));
        }
    }

    pbs::ConstraintSet<double> constraints;
    std::vector<Vec3> p, q;
};

TEST_F(ProjectPlain, BindByVertex)
{
    std::vector<Vec3> expected = p;
    for (const auto& c : constraints.bind) project(c, constraints.inverse_mass[c.vertex], q[c.vertex], expected[c.vertex]);
    pbs::project_bind_constraints(constraints, q, p);
    EXPECT_EQ(p, expected);
}

TEST_F(ProjectPlain, StretchByEdge)
{
    const std::vector<double>& w = constraints.inverse_mass;
    std::vector<Vec3> expected = p;
    for (const auto& c : constraints.stretch) project(c, w[c.vertex[0]], w[c.vertex[1]], expected[c.vertex[0]], expected[c.vertex[1]]);
    pbs::project_stretch_constraints(constraints, p);
    EXPECT_EQ(p, expected);
}

TEST_F(ProjectPlain, VolumeByTet)
{
    const std::vector<double>& w = constraints.inverse_mass;
    std::vector<Vec3> expected = p;
    for (const auto& c : constraints.volume)
        project(c, w[c.vertex[0]], w[c.vertex[1]], w[c.vertex[2]], w[c.vertex[3]], expected[c.vertex[0]], expected[c.vertex[1]],
                expected[c.vertex[2]], expected[c.vertex[3]]);
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

}  // namespace
