// Reference: the paper's Table 1 counted by hand.
#include "experiments/studies/shared/table_1.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::PrintedFigure;

bool consistent(const PrintedFigure& figure)
{
    return figure.is_consistent();
}

PrintedFigure figure_of(const std::vector<PrintedFigure>& figures, const std::string& model, const std::string& quantity)
{
    const auto found =
        std::find_if(figures.begin(), figures.end(), [&](const PrintedFigure& f) { return f.of.model == model && f.quantity == quantity; });
    return found == figures.end() ? PrintedFigure{} : *found;
}

TEST(TableOne, EdgesOfManAndBunnyAreFewerThanAnyTetMeshHas)
{
    const auto figures = experiments::table_1_figures();
    EXPECT_EQ(figure_of(figures, "Man", "stretch_constraints").least, 1654 + 4998 + 1);
    EXPECT_FALSE(consistent(figure_of(figures, "Man", "stretch_constraints")));
    EXPECT_FALSE(consistent(figure_of(figures, "bunny", "stretch_constraints")));
    EXPECT_TRUE(consistent(figure_of(figures, "ManHQ", "stretch_constraints")));
    EXPECT_TRUE(consistent(figure_of(figures, "bunnyHQ", "stretch_constraints")));
    EXPECT_TRUE(consistent(figure_of(figures, "Lady", "stretch_constraints")));
}

TEST(TableOne, NoTotalHoldsItsParts)
{
    for (const auto& row : experiments::table_1())
        EXPECT_FALSE(consistent(figure_of(experiments::table_1_figures(), row.model, "ct_total_ms"))) << row.model;
}

TEST(TableOne, FrameRateAsksForTwentyTimesTheTotal)
{
    const PrintedFigure man = figure_of(experiments::table_1_figures(), "Man", "ct_total_of_1_s_ms");
    EXPECT_NEAR(0.5 * (man.least + man.most), 1105.0, 1.0);
    EXPECT_EQ(man.printed, 52.0);
    EXPECT_FALSE(consistent(man));
}

TEST(TableOne, EveryVertexIsBound)
{
    for (const auto& row : experiments::table_1())
        EXPECT_TRUE(consistent(figure_of(experiments::table_1_figures(), row.model, "bind_constraints"))) << row.model;
}

TEST(TableOne, MeshesOfRoughly2KVerticesHaveFewerThan10KTets)
{
    const auto figures = experiments::mesh_size_figures();
    ASSERT_EQ(figures.size(), 3u);
    EXPECT_TRUE(consistent(figures[0]));
    EXPECT_TRUE(consistent(figures[1]));
    EXPECT_EQ(figures[2].most, 7827);
    EXPECT_FALSE(consistent(figures[2]));
}

}  // namespace
