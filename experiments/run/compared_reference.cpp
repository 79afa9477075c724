#include "experiments/run/compared_reference.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/run/spread_reference.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

const char* remedy_of_lag(const DeformerSpec& reference)
{
    const auto* fem = options_if<FemOptions>(reference);
    return fem && fem->attachment == FemAttachment::held
               ? "finer tets (character.vertices, --vertices of a trial) or weights of 1 in a wider band let tets "
                 "belong to that bone alone"
               : "attachment = \"held\" of [[fem]] ties such flesh to its bone";
}

// No deformer is compared with inverted flesh. The linear model is a negative control, which inverts tets at large
// rotations.
bool can_be_compared_with(const Runner& reference, const FrameMeasurer& measurer)
{
    return reference.deformer->has_state() && reference.steps.summary().outcome == pbs::Outcome::finished &&
           (reference.traits.is_negative_control || !reference.has_inverted_flesh(measurer));
}

}  // namespace

ComparedReference::ComparedReference(const Scene& scene, const pbs::Character& character, Runner& runner,
                                     CostRecord& cost)
    : scene_(scene), character_(character), runner_(runner), cost_(cost)
{
    if (scene.error_bar != ErrorBar::none)
        cost.time("error_bar_set_up", [&] { error_bar_.emplace(runner.spec, character); });
}

const ReferenceOutcome* ComparedReference::spread() const
{
    const auto* reference = dynamic_cast<const SpreadReference*>(runner_.deformer.get());
    return reference ? &reference->outcome() : nullptr;
}

void ComparedReference::note_contact()
{
    if (const ReferenceOutcome* outcome = spread(); outcome && outcome->with_contact)
        options_of<FemOptions>(runner_.spec).contact = false;
}

void ComparedReference::give_up_when(const std::function<bool()>& is_over)
{
    runner_.deformer->give_up_when(is_over);
    if (error_bar_) error_bar_->give_up_when(is_over);
}

void ComparedReference::advance(const pbs::Pose& pose, double dt_s)
{
    if (error_bar_) cost_.time("error_bar", [&] { error_bar_->advance(pose, dt_s); });
}

FrameContext ComparedReference::context(int frame, const pbs::Pose& pose, FrameMeasurer& measurer)
{
    ++frames_;
    FrameContext context{.pose = &pose};
    if (!scene_.output.errors || runner_.spec.name != scene_.reference || !can_be_compared_with(runner_, measurer))
        return context;
    const pbs::Positions& positions = runner_.deformer->positions();
    context.reference = &positions;
    cost_.time("metrics", [&] {
        const FemFacts* facts = runner_.deformer->facts();
        const double masked_share_pct = measurer.leave_out(facts ? facts->tips : std::vector<CreaseTip>());
        largest_masked_share_pct_ = std::max(largest_masked_share_pct_, masked_share_pct);
        find_overlap(frame, positions, measurer);
        find_lag(frame, positions, pose);
    });
    if (error_bar_) cost_.time("error_bar", [&] { context.reference_error = error_bar_->bound(positions, measurer); });
    return context;
}

void ComparedReference::find_overlap(int frame, const pbs::Positions& positions, const FrameMeasurer& measurer)
{
    const auto* fem = options_if<FemOptions>(runner_.spec);
    if ((fem && fem->has_contact()) || !measurer.overlaps(positions)) return;
    if (frames_with_overlap_++ == 0) first_frame_with_overlap_ = frame;
}

void ComparedReference::find_lag(int frame, const pbs::Positions& positions, const pbs::Pose& pose)
{
    if (!parts_) parts_.emplace(character_);
    PartLag lag = parts_->largest_lag(positions, pose);
    lag.frame = frame;
    ++frames_searched_for_lag_;
    frames_with_lag_ += lag.share >= much_lagging_share;
    if (lag.bone >= 0 && (largest_lag_.bone < 0 || lag.turn_deg > largest_lag_.turn_deg)) largest_lag_ = lag;
}

const std::string& ComparedReference::bone_that_lags() const
{
    return character_.skeleton.bones[static_cast<std::size_t>(largest_lag_.bone)].name;
}

bool ComparedReference::was_interrupted() const
{
    return spread() && spread()->was_interrupted;
}

nlohmann::json ComparedReference::record() const
{
    nlohmann::json record = nlohmann::json::object();
    if (error_bar_) record["frames_below_reference_error"] = frames_below_error_;
    if (scene_.reference.empty()) return record;
    record["frames_with_overlap"] = frames_with_overlap_;
    record["largest_masked_share_pct"] = largest_masked_share_pct_;
    record["reference_lag"] = nullptr;
    if (largest_lag_.bone >= 0)
        record["reference_lag"] = {{"largest_turn_deg", largest_lag_.turn_deg},
                                   {"bone", bone_that_lags()},
                                   {"frame", largest_lag_.frame},
                                   {"lagging_frames", frames_with_lag_},
                                   {"frames", frames_searched_for_lag_}};
    record["reference_frames"] = nullptr;
    if (spread()) {
        record["reference_frames"] = *spread();
        record["reference_frames"]["budget_s"] = scene_.reference_seconds;
    }
    return record;
}

pbs::RemarkList ComparedReference::remarks() const
{
    pbs::RemarkList remarks;
    // A head that is longer than its bone is not held by springs around the bone, and a band that is thinner than two
    // tets not at all.
    if (largest_lag_.bone >= 0 && largest_lag_.turn_deg > much_lag_deg)
        remarks.push_back(
            {frames_with_lag_ > most_lagging_frames * frames_searched_for_lag_ ? pbs::Gravity::comparison_wrong
                                                                               : pbs::Gravity::information,
             fmt::format(
                 "{}: in the reference, the flesh that {} alone moves is turned by up to {:.0f} degrees against it, "
                 "in frame {}. In {} of {} frames, {:.0f} % of the body or more lag by more than {:.0f} degrees. {}",
                 scene_.file, bone_that_lags(), largest_lag_.turn_deg, largest_lag_.frame, frames_with_lag_,
                 frames_searched_for_lag_, 100.0 * much_lagging_share, much_lag_deg, remedy_of_lag(runner_.spec))});
    if (const ReferenceOutcome* outcome = spread())
        for (const pbs::Remark& remark : remarks_on(*outcome, scene_.file)) remarks.push_back(remark);
    if (frames_with_overlap_ > 0)
        remarks.push_back(
            {pbs::Gravity::comparison_wrong,
             fmt::format("{}: the reference passes through itself in {} of {} frames, first in frame {}, and has no "
                         "contact: errors compare with that",
                         scene_.file, frames_with_overlap_, frames_, first_frame_with_overlap_)});
    return remarks;
}

}  // namespace experiments
