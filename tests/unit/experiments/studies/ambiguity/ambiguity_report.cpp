// Reference: the description in ambiguity_report.hpp; the values are invented.
#include "experiments/studies/ambiguity/ambiguity_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace {

using analysis::Extent;
using experiments::ClaimChange;
using experiments::Reading;
using experiments::ReadingValues;

Reading named(const std::string& name)
{
    return {.place = "jiggling", .name = name, .baseline = "A", .options = {}};
}

ReadingValues with(const std::string& claim, double value, Extent extent)
{
    return {{{claim, "quantity", {.body = "limb"}, "1", "1 or more", value, extent}}, false};
}

// Appends the changes of one reading.
void add(std::vector<ClaimChange>& changes, const std::string& claim, const Reading& reading, const ReadingValues& a,
         const ReadingValues& b)
{
    std::ranges::copy(experiments::claim_changes("limb", claim, reading, a, b), std::back_inserter(changes));
}

bool has(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

TEST(ClaimChangesText, ShowsTheRatioAndMarksAFlip)
{
    std::vector<ClaimChange> changes;
    add(changes, "C02", named("B"), with("C02", 2.0, Extent::whole), with("C02", 0.5, Extent::none));
    add(changes, "C07", named("B"), with("C07", 2.0, Extent::whole), with("C07", 3.0, Extent::whole));
    const std::string text = experiments::claim_changes_text(changes);
    EXPECT_TRUE(has(text, "x0.25!")) << text;
    EXPECT_TRUE(has(text, "x1.5 ") || has(text, "x1.5\n")) << text;
    EXPECT_TRUE(has(text, "C02: 1 of 1 values flip by limb, B")) << text;
    EXPECT_TRUE(has(text, "C07: 0 of 1 values flip")) << text;
}

// A small value that flips comes before a large one that does not.
TEST(ClaimChangesText, ShowsTheFigureThatFlips)
{
    std::vector<ClaimChange> changes;
    ReadingValues a = with("C02", 1.0, Extent::whole), b = with("C02", 9.0, Extent::whole);
    a.values.push_back({"C02", "other", {.body = "limb"}, "1", "", 1.0, Extent::whole});
    b.values.push_back({"C02", "other", {.body = "limb"}, "1", "", 1.1, Extent::part});
    add(changes, "C02", named("B"), a, b);
    EXPECT_TRUE(has(experiments::claim_changes_text(changes), "x1.1!"));
}

TEST(ClaimChangesText, HasADotWhereNotTouchedAndSaysWhy)
{
    std::vector<ClaimChange> changes;
    changes.push_back(experiments::untouched_claim("limb", "C10", named("B"), "another factor is no more work"));
    const std::string text = experiments::claim_changes_text(changes);
    EXPECT_TRUE(has(text, " .\n")) << text;
    EXPECT_TRUE(has(text, "not touched where another factor is no more work")) << text;
}

TEST(ClaimChangesText, OfAClaimWithoutAValueHasADash)
{
    std::vector<ClaimChange> changes;
    add(changes, "C03", named("B"), {}, {});
    EXPECT_TRUE(has(experiments::claim_changes_text(changes), " -\n"));
}

// All quantities with the same reason share a line; the cell shows the quantity that has a value.
TEST(ClaimChangesText, SaysWhichQuantitiesAreLeftOutAndWhy)
{
    std::vector<ClaimChange> changes;
    ReadingValues a = with("C09", 2.0, Extent::whole), b = with("C09", 3.0, Extent::whole);
    a.left_out = b.left_out = {{"C09", "share", "four settings"}, {"C09", "range", "four settings"}};
    add(changes, "C09", named("B"), a, b);
    add(changes, "C09", named("other"), a, b);
    const std::string text = experiments::claim_changes_text(changes);
    EXPECT_TRUE(has(text, "no value: four settings: share, range\n")) << text;
    EXPECT_TRUE(has(text, "x1.5\n")) << text;
    EXPECT_TRUE(has(text, "C09: 0 of 2 values flip\n")) << text;
}

TEST(ClaimChangesText, OfAReadingThatBreaksDownMarksTheFlip)
{
    std::vector<ClaimChange> changes;
    add(changes, "C03", named("B"), with("C03", 2.0, Extent::whole), {{}, true});
    EXPECT_TRUE(has(experiments::claim_changes_text(changes), " -!\n"));
}

TEST(ClaimChangesText, IsAtMost120ColumnsWide)
{
    std::vector<ClaimChange> changes;
    for (const char* claim : {"C01", "C02", "C03", "C04", "C05", "C07", "C09", "C10", "C12"})
        for (int i = 0; i < 20; ++i)
            add(changes, claim, named("a reading that has a name of some length, " + std::to_string(i)), with(claim, 1.0, Extent::whole),
                with(claim, 1.234e-12, Extent::none));
    std::istringstream lines(experiments::claim_changes_text(changes));
    std::size_t widest = 0;
    for (std::string line; std::getline(lines, line);) widest = std::max(widest, line.size());
    EXPECT_LE(widest, 120u);
    EXPECT_GT(widest, 100u);
}

}  // namespace
