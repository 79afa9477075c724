// Truth: the paper's Table 1 counted by hand.
#include "experiments/studies/shared/table_1.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::PrintedFigure;

bool consistent(const PrintedFigure& figure)
{
    return figure.least <= figure.printed && figure.printed <= figure.most;
}

PrintedFigure figure_of(const std::vector<PrintedFigure>& figures, const std::string& what)
{
    const auto found = std::find_if(figures.begin(), figures.end(), [&](const PrintedFigure& f) { return f.what.starts_with(what); });
    return found == figures.end() ? PrintedFigure{} : *found;
}

TEST(TableOne, EdgesOfManAndBunnyAreFewerThanAnyTetMeshHas)
{
    const auto figures = experiments::table_1_figures();
    EXPECT_EQ(figure_of(figures, "Man: stretch").least, 1654 + 4998 + 1);
    EXPECT_FALSE(consistent(figure_of(figures, "Man: stretch")));
    EXPECT_FALSE(consistent(figure_of(figures, "bunny: stretch")));
    EXPECT_TRUE(consistent(figure_of(figures, "ManHQ: stretch")));
    EXPECT_TRUE(consistent(figure_of(figures, "bunnyHQ: stretch")));
    EXPECT_TRUE(consistent(figure_of(figures, "Lady: stretch")));
}

TEST(TableOne, NoTotalHoldsItsParts)
{
    for (const auto& row : experiments::table_1())
        EXPECT_FALSE(consistent(figure_of(experiments::table_1_figures(), row.model + ": CT total [ms], which"))) << row.model;
}

TEST(TableOne, FrameRateAsksForTwentyTimesTheTotal)
{
    const PrintedFigure man = figure_of(experiments::table_1_figures(), "Man: CT total of 1 s");
    EXPECT_NEAR(0.5 * (man.least + man.most), 1105.0, 1.0);
    EXPECT_EQ(man.printed, 52.0);
    EXPECT_FALSE(consistent(man));
}

TEST(TableOne, EveryVertexIsBound)
{
    for (const auto& row : experiments::table_1())
        EXPECT_TRUE(consistent(figure_of(experiments::table_1_figures(), row.model + ": bind"))) << row.model;
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
