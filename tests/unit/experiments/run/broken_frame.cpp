// Reference: the vertices and tets that were broken.
#include "experiments/run/frame_measurement.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace experiments;

pbs::Positions four_points()
{
    return pbs::Positions::Random(4, 3);
}

Eigen::VectorXd ratios(std::initializer_list<double> values)
{
    return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

TEST(BrokenFrame, NamesTheFirstVertexThatIsNotFinite)
{
    pbs::Positions points = four_points();
    points(3, 0) = std::numeric_limits<double>::infinity();
    points(2, 1) = std::numeric_limits<double>::quiet_NaN();
    const BrokenFrame broken = broken_frame(5, pbs::Outcome::not_finite, points, ratios({std::nan("")}));
    EXPECT_EQ(text_of(broken), "not finite in frame 5: first at vertex 2, 2 not finite");
    EXPECT_EQ(nlohmann::json(broken),
              (nlohmann::json{{"frame", 5}, {"what", "not_finite"}, {"first_vertex", 2}, {"vertices_not_finite", 2}}));
}

TEST(BrokenFrame, NamesTheWorstTet)
{
    const BrokenFrame broken = broken_frame(7, pbs::Outcome::finished, four_points(), ratios({1.0, 0.0, -0.25, 0.5}));
    EXPECT_EQ(text_of(broken), "inverted in frame 7: worst tet 2 of volume ratio -0.25, 2 inverted");
    EXPECT_EQ(nlohmann::json(broken),
              (nlohmann::json{{"frame", 7}, {"what", "inverted"}, {"worst_tet", 2}, {"volume_ratio", -0.25}, {"inverted_tets", 2}}));
}

TEST(BrokenFrame, AStepThatDidNotConvergeNamesTheWorstTetWithoutAnyInverted)
{
    const BrokenFrame broken = broken_frame(0, pbs::Outcome::not_converged, four_points(), ratios({1.0, 0.9}));
    EXPECT_EQ(text_of(broken), "not converged in frame 0: worst tet 1 of volume ratio 0.9, 0 inverted");
}

TEST(BrokenFrame, AStepBeforeTheFramesOwnIsNamed)
{
    BrokenFrame broken = broken_frame(2, pbs::Outcome::not_finite, four_points(), ratios({1.0, 0.9}));
    broken.step = 7;
    EXPECT_EQ(text_of(broken), "not finite in frame 2 (in step 7, before it): worst tet 1 of volume ratio 0.9, 0 inverted");
    EXPECT_EQ(nlohmann::json(broken).at("step"), 7);
    EXPECT_EQ(text_of(nlohmann::json(broken).get<BrokenFrame>()), text_of(broken));
}

TEST(BrokenFrame, WithoutTetsThereIsNone)
{
    EXPECT_EQ(broken_frame(0, pbs::Outcome::not_converged, pbs::Positions(0, 3), Eigen::VectorXd()).tet, -1);
}

}  // namespace
