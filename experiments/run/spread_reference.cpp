#include "experiments/run/spread_reference.hpp"

#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/run/region_record.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/pose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace experiments {
namespace {

constexpr int shares_of_what_is_left = 8;
constexpr double longest_over_mean = 3.0;
constexpr int least_held_up = 2, held_up_of = 4;  // so many frames, and more than one of so many
constexpr int coarsest = 4;  // every fourth frame is solved first, so that an interruption leaves spread ones

}  // namespace

int stride(int frames_left, double mean_s, double seconds_left)
{
    return std::clamp(static_cast<int>(std::ceil(std::min(1e9, frames_left * mean_s / seconds_left))), 1,
                      std::max(1, frames_left));
}

double share_of_frame(int frames_left, double mean_reached_s, double seconds_left)
{
    const double equal_s = seconds_left / std::clamp(frames_left, 1, shares_of_what_is_left);
    return std::min(seconds_left, std::max(equal_s, longest_over_mean * mean_reached_s));
}

SpreadReference::SpreadReference(const DeformerSpec& spec, ReferenceBudget budget)
    : spec_(spec),
      deformer_(make_deformer(spec)),
      budget_(std::move(budget)),
      kept_(budget_.file, budget_.key, budget_.seconds)
{
}

void SpreadReference::reset(const pbs::Character& character)
{
    character_ = &character;
    deformer_->reset(character);
    facts_ = {};
    facts_.prescribed = prescribed_vertices(*deformer_);
    facts_.last_state = character.mesh.rest;
    frames_.clear();
    tried_ = 0;
    at_ = frame_ = -1;
    spent_before_s_ = reached_s_ = 0.0;
    outcome_ = {};
}

void SpreadReference::foresee(const std::vector<pbs::Pose>& poses)
{
    for (const pbs::Pose& pose : poses) frames_.push_back({pose, pbs::RootFrame(character_->skeleton, pose).pose()});
    outcome_.frames = static_cast<int>(frames_.size());
    find_kept(poses);
    progress_.emplace("reference", outcome_.frames);
    std::set<int> left;
    for (int number = 0; number < outcome_.frames; ++number)
        if (!is_solved(number)) left.insert(number);
    const NotedInterrupts noted;
    try {
        for (int least = coarsest; !left.empty() && has_time_left(); least = std::max(1, least / 2)) pass(left, least);
        const bool is_tried_again = !outcome_.is_hopeless();
        const std::vector<FrameNotReached> again =
            is_tried_again ? std::exchange(outcome_.not_reached, {}) : std::vector<FrameNotReached>();
        for (std::size_t k = 0; k < again.size(); ++k) {
            const auto count = static_cast<int>(again.size() - k);
            if (has_time_left()) solve(again[k].frame, count);
            const auto is_same = [&](const FrameNotReached& not_reached) {
                return not_reached.frame == again[k].frame;
            };
            if (!is_solved(again[k].frame) && std::ranges::none_of(outcome_.not_reached, is_same))
                outcome_.not_reached.push_back(again[k]);
        }
    } catch (const Interrupted&) {
        kept_.write();
        throw;
    }
    kept_.write();
    progress_.reset();
}

// Once through those that are left, which loses each one that is tried.
void SpreadReference::pass(std::set<int>& left, int least_stride)
{
    for (auto next = left.begin(); next != left.end() && has_time_left();) {
        const auto after = [&] { return static_cast<int>(std::distance(next, left.end())); };
        solve(*next, after());
        if (is_held_up_by_contact()) {
            kept_.begin_without_contact(outcome_.not_reached.front());
            do_without_contact(*kept_.with_contact());
            for (int number = 0; number < outcome_.frames; ++number) left.insert(number);
            next = left.begin();
            continue;
        }
        next = left.erase(next);
        if (has_time_left())
            std::advance(next, std::min(after(), std::max(least_stride,
                                                          stride(after(), (outcome_.seconds - spent_before_s_) / tried_,
                                                                 budget_.seconds - outcome_.seconds)) -
                                                     1));
    }
}

bool SpreadReference::is_held_up_by_contact() const
{
    const auto held_up = static_cast<int>(outcome_.not_reached.size());
    return options_of<FemOptions>(spec_).has_contact() && !outcome_.was_interrupted &&
           2.0 * outcome_.seconds < budget_.seconds && held_up >= std::min(least_held_up, outcome_.frames) &&
           held_up_of * held_up > outcome_.kept + tried_;
}

void SpreadReference::find_kept(const std::vector<pbs::Pose>& poses)
{
    std::vector<std::optional<SolvedFrame>> found = kept_.find(poses, character_->mesh.rest.rows());
    if (const auto& frame = kept_.with_contact()) do_without_contact(*frame);
    for (std::size_t number = 0; number < found.size(); ++number) {
        outcome_.kept += found[number].has_value();
        frames_[number].solution = std::move(found[number]);
    }
    outcome_.solved = outcome_.kept;
}

void SpreadReference::do_without_contact(const FrameNotReached& frame_with_contact)
{
    outcome_.with_contact = frame_with_contact;
    outcome_.not_reached.clear();
    outcome_.solved = outcome_.kept = tried_ = 0;
    spent_before_s_ = outcome_.seconds;
    reached_s_ = 0.0;
    at_ = -1;
    for (Frame& frame : frames_) frame.solution.reset();
    options_of<FemOptions>(spec_).contact = false;
    deformer_ = make_deformer(spec_);
    deformer_->reset(*character_);
}

bool SpreadReference::has_time_left() const
{
    return !outcome_.was_interrupted && !outcome_.is_hopeless() && outcome_.seconds < budget_.seconds;
}

void SpreadReference::solve(int number, int frames_left)
{
    const int reached = outcome_.solved - outcome_.kept;
    const double share_s =
        share_of_frame(frames_left, reached > 0 ? reached_s_ / reached : 0.0, budget_.seconds - outcome_.seconds);
    Frame& frame = frames_[static_cast<std::size_t>(number)];
    ++tried_;
    const double start_s = budget_.clock_s();
    const auto spent_s = [&] { return budget_.clock_s() - start_s; };
    deformer_->give_up_when([&] {
        progress_->advance_to(outcome_.solved,
                              fmt::format("frames, {:.0f} of {:.0f} s", outcome_.seconds + spent_s(), budget_.seconds));
        return interrupted() || spent_s() > share_s;
    });
    continue_from_most_similar(number);
    SolvedFrame solution{.step = deformer_->advance(frame.pose, 0.0)};
    const double seconds = spent_s();
    outcome_.seconds += seconds;
    if (solution.step.outcome == pbs::Outcome::finished) {
        solution.positions = deformer_->positions();
        if (const FemFacts* facts = deformer_->facts()) {
            solution.lowest_det_f = facts->lowest_det_f;
            solution.tips = facts->tips;
        }
        frame.solution = std::move(solution);
        at_ = number;
        reached_s_ += seconds;
        ++outcome_.solved;
        kept_.add(frame.pose, *frame.solution);
    } else if (!interrupted()) {
        outcome_.not_reached.push_back({number, seconds, most_distorted_bone()});
    }
    if (!interrupted()) return;
    if (!budget_.goes_on_without_the_rest) stop_if_interrupted();
    outcome_.was_interrupted = take_interruption();
}

void SpreadReference::continue_from_most_similar(int number)
{
    int before = number - 1, after = number + 1;
    while (before >= 0 && !is_solved(before)) --before;
    if (before >= 0 && before == std::exchange(at_, -1)) return;  // where the deformer is
    while (after < outcome_.frames && !is_solved(after)) ++after;
    pbs::Pose from(character_->skeleton.bones.size(), Eigen::Isometry3d::Identity());
    const pbs::Positions* positions = &character_->mesh.rest;
    const pbs::Pose& wanted = frames_[static_cast<std::size_t>(number)].relative;
    const auto turn_deg = [&](const pbs::Pose& pose) {
        return pbs::PosePath(character_->skeleton, pose, wanted).largest_turn_deg();
    };
    double least_deg = turn_deg(from);
    for (const int other : {before, after}) {
        if (other < 0 || other >= outcome_.frames) continue;
        const Frame& solved = frames_[static_cast<std::size_t>(other)];
        const double deg = turn_deg(solved.relative);
        if (!(deg < least_deg)) continue;
        least_deg = deg;
        from = solved.pose;
        positions = &solved.solution->positions;
    }
    deformer_->continue_from(from, *positions);
}

std::string SpreadReference::most_distorted_bone() const
{
    const pbs::TetMesh& mesh = character_->mesh;
    const pbs::Positions& state = last_state(*deformer_);
    if (!state.allFinite()) return "";
    Eigen::Index tet = 0;
    pbs::tet_volumes(state, mesh.tets).cwiseQuotient(pbs::tet_volumes(mesh.rest, mesh.tets)).minCoeff(&tet);
    const int bone = regions_by_bone(*character_).of_tet[static_cast<std::size_t>(tet)];
    return character_->skeleton.bones[static_cast<std::size_t>(bone)].name;
}

pbs::StepSummary SpreadReference::advance(const pbs::Pose&, double)
{
    const std::optional<SolvedFrame>& solution = frames_.at(static_cast<std::size_t>(++frame_)).solution;
    facts_.lowest_det_f.reset();
    facts_.tips.clear();
    if (!solution) return {};
    facts_.lowest_det_f = solution->lowest_det_f;
    facts_.tips = solution->tips;
    facts_.last_state = solution->positions;
    return solution->step;
}

bool SpreadReference::has_state() const
{
    return frame_ >= 0 && frames_[static_cast<std::size_t>(frame_)].solution.has_value();
}

}  // namespace experiments
