// Reference: three frames whose worst one is visible at a glance.

#include "analysis/check/check.hpp"
#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using analysis::FrameBound;
using analysis::Measured;

analysis::MeasuredFrame named_frame(const std::string& name, double volume_change_pct, int inverted_tets)
{
    analysis::FrameValues values;
    values.metrics.volume_change_pct = volume_change_pct;
    values.metrics.inverted_tets = inverted_tets;
    return {name, values};
}

const std::vector<analysis::MeasuredFrame> three_frames = {named_frame("0", 0.25, 0), named_frame("1", -8.64, 2),
                                                           named_frame("2", 3.0, 1)};

// The known bounds with the values of some.
std::vector<FrameBound> asked_bounds(const std::vector<std::pair<std::string, double>>& values)
{
    std::vector<FrameBound> known = analysis::known_frame_bounds();
    for (const auto& [option, value] : values)
        for (FrameBound& bound : known)
            if (bound.option == option) bound.value = value;
    return known;
}

TEST(FrameSummary, IsOneLineWithTheWorstFrameAndItsSign)
{
    const auto summary = [](const auto& values, std::size_t refused = 0) {
        return frame_summary(asked_bounds(values), three_frames, refused);
    };
    using Values = std::vector<std::pair<std::string, double>>;
    EXPECT_EQ(summary(Values{{"--max-volume-change", 0.5}}),
              "fails: 2 of 3 frames beyond 0.5 %, worst -8.64 % in frame 1");
    EXPECT_EQ(summary(Values{{"--max-volume-change", 9.0}}), "holds: 3 frames within 9 %, worst -8.64 % in frame 1");
    EXPECT_EQ(summary(Values{{"--max-volume-change", 9.0}, {"--max-inverted", 1.0}}),
              "fails: inverted_tets: 1 of 3 frames beyond 1, worst 2 in frame 1");
    EXPECT_EQ(summary(Values{}), "measured: 3 frames, volume -8.64 % in frame 1 to 3 % in frame 2");
    EXPECT_EQ(summary(Values{{"--max-volume-change", 9.0}}, 1),
              "refused: 1 of 4 frames could not be measured; the others: holds: 3 frames within 9 %, worst -8.64 % in "
              "frame 1");
    EXPECT_EQ(analysis::frame_summary(asked_bounds({}), {}, 2), "refused: 2 of 2 frames could not be measured");
    EXPECT_EQ(analysis::frame_summary(asked_bounds({}), {three_frames[0]}, 0), "measured: 1 frame, volume 0.25 %");
}

TEST(FrameBounds, AreRefusedWhereTheyDoNotApply)
{
    for (const FrameBound& bound : analysis::known_frame_bounds()) {
        FrameBound asked = bound;
        asked.value = 1.0;
        for (const Measured measured : {Measured::tets, Measured::surface}) {
            EXPECT_NO_THROW(require_meaningful(bound, measured)) << "not asked for";
            if (bound.applies_to == Measured::both || bound.applies_to == measured) {
                EXPECT_NO_THROW(require_meaningful(asked, measured)) << bound.option;
            } else {
                EXPECT_THROW(require_meaningful(asked, measured), pbs::InputError) << bound.option;
            }
        }
    }
}

}  // namespace
