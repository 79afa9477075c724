#include "experiments/run/reference_outcome.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace experiments {
namespace {

constexpr int hopeless = 4;    // so many frames that were not reached, and at most one that was
constexpr int few_frames = 5;  // on which a comparison rests

}  // namespace

bool ReferenceOutcome::is_hopeless() const
{
    const auto in_vain = static_cast<int>(not_reached.size());
    return solved <= 1 && in_vain >= hopeless && solved + in_vain < frames;
}

void to_json(nlohmann::json& json, const FrameNotReached& frame)
{
    json = {{"frame", frame.frame}, {"cpu_seconds", frame.seconds}, {"bone", frame.bone}};
}

void to_json(nlohmann::json& json, const ReferenceOutcome& outcome)
{
    json = {{"frames", outcome.frames},       {"solved", outcome.solved},         {"kept", outcome.kept},
            {"cpu_seconds", outcome.seconds}, {"contact", !outcome.with_contact}, {"not_reached", outcome.not_reached}};
}

pbs::RemarkList remarks_on(const ReferenceOutcome& outcome, const std::string& scene_file)
{
    pbs::RemarkList remarks;
    const auto add = [&](pbs::Gravity gravity, const std::string& text) {
        remarks.push_back({gravity, scene_file + ": " + text});
    };
    const auto held_up_by = [](const FrameNotReached& frame) {
        return frame.bone.empty() ? std::string() : fmt::format(": the flesh of {} holds it up", frame.bone);
    };
    if (const auto& frame = outcome.with_contact)
        add(pbs::Gravity::comparison_wrong,
            fmt::format(
                "the reference has no contact, for with it frame {} was not reached in {:.0f} s{}; --reference-seconds "
                "(reference.seconds) with more time, or 0 for all of it, tries again",
                frame->frame, frame->seconds, held_up_by(*frame)));
    if (!outcome.not_reached.empty()) {
        const FrameNotReached& first = outcome.not_reached.front();
        add(pbs::Gravity::comparison_wrong,
            fmt::format("the reference did not reach {} of {} frames, which have no errors; frame {} took "
                        "{:.0f} s{}",
                        outcome.not_reached.size(), outcome.frames, first.frame, first.seconds, held_up_by(first)));
    }
    if (outcome.solved + static_cast<int>(outcome.not_reached.size()) == outcome.frames) return remarks;
    add(outcome.solved < few_frames ? pbs::Gravity::comparison_wrong : pbs::Gravity::information,
        fmt::format(
            "the reference has {} of {} frames{}: {}", outcome.solved, outcome.frames,
            outcome.solved > 0 ? ", and only they have errors" : ", so that no method has an error",
            outcome.was_interrupted ? "it was interrupted"
            : outcome.is_hopeless()
                ? fmt::format("after {} frames that were not reached the others were not tried; --reference-seconds "
                              "(reference.seconds) gives each of them more time",
                              outcome.not_reached.size())
                : fmt::format("they are spread over the motion as evenly as {:.0f} s of processor time allow "
                              "(--reference-seconds, reference.seconds)",
                              outcome.seconds)));
    return remarks;
}

}  // namespace experiments
