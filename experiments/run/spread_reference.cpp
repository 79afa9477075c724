#include "experiments/run/spread_reference.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/run/region_record.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/pose.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <limits>
#include <utility>

namespace experiments {
namespace {

constexpr int shares_of_what_is_left = 8;
constexpr double longest_over_mean = 3.0;
constexpr int least_held_up = 2, held_up_of = 4;  // so many frames, and more than one of so many
constexpr int coarsest = 4;    // every fourth frame is solved first, so that an interruption leaves spread ones
constexpr int hopeless = 4;    // so many frames that were not reached, and at most one that was
constexpr int few_frames = 5;  // on which a comparison rests
constexpr double between_writings_s = 1.0;

std::string hash_of(const pbs::Pose& pose)
{
    analysis::StateHash hash;
    for (const Eigen::Isometry3d& bone : pose)
        hash.add_bytes(bone.data(), static_cast<std::size_t>(bone.matrix().size()) * sizeof(double));
    return hash.hex();
}

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
    : spec_(spec), deformer_(make_deformer(spec)), budget_(std::move(budget))
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
    find_kept();
    progress_.emplace("reference", outcome_.frames);
    std::set<int> left;
    for (int number = 0; number < outcome_.frames; ++number)
        if (!is_solved(number)) left.insert(number);
    const NotedInterrupts noted;
    try {
        for (int least = coarsest; !left.empty() && has_time_left(); least = std::max(1, least / 2)) pass(left, least);
        const bool is_tried_again = !outcome_.is_hopeless();
        const std::vector<NotReached> again =
            is_tried_again ? std::exchange(outcome_.not_reached, {}) : std::vector<NotReached>();
        for (std::size_t k = 0; k < again.size(); ++k) {
            const auto count = static_cast<int>(again.size() - k);
            if (has_time_left()) solve(again[k].frame, count);
            const auto is_same = [&](const NotReached& not_reached) { return not_reached.frame == again[k].frame; };
            if (!is_solved(again[k].frame) && std::ranges::none_of(outcome_.not_reached, is_same))
                outcome_.not_reached.push_back(again[k]);
        }
    } catch (const Interrupted&) {
        keep();
        throw;
    }
    keep();
    progress_.reset();
}

// Once through those that are left, which loses each one that is tried.
void SpreadReference::pass(std::set<int>& left, int least_stride)
{
    for (auto next = left.begin(); next != left.end() && has_time_left();) {
        const auto after = [&] { return static_cast<int>(std::distance(next, left.end())); };
        solve(*next, after());
        if (is_held_up_by_contact()) {
            do_without_contact();
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

void SpreadReference::do_without_contact()
{
    outcome_.with_contact = outcome_.not_reached.front();
    outcome_.not_reached.clear();
    outcome_.solved = outcome_.kept = tried_ = 0;
    spent_before_s_ = outcome_.seconds;
    reached_s_ = 0.0;
    at_ = -1;
    kept_frames_ = nlohmann::json::object();
    for (Frame& frame : frames_) frame.solution.reset();
    options_of<FemOptions>(spec_).contact = false;
    deformer_ = make_deformer(spec_);
    deformer_->reset(*character_);
}

bool SpreadReference::has_time_left() const
{
    return !outcome_.was_interrupted && !outcome_.is_hopeless() && outcome_.seconds < budget_.seconds;
}

bool SpreadReference::Outcome::is_hopeless() const
{
    const auto in_vain = static_cast<int>(not_reached.size());
    return solved <= 1 && in_vain >= hopeless && solved + in_vain < frames;
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
    Solution solution{.step = deformer_->advance(frame.pose, 0.0)};
    const double seconds = spent_s();
    outcome_.seconds += seconds;
    if (solution.step.outcome == pbs::Outcome::finished) {
        solution.positions = deformer_->positions();
        if (const FemFacts* facts = deformer_->facts())
            solution.lowest_det_f = facts->lowest_det_f, solution.tips = facts->tips;
        frame.solution = std::move(solution);
        at_ = number;
        reached_s_ += seconds;
        ++outcome_.solved;
        if (since_keeping_.seconds() > between_writings_s) keep();
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
        if (const double deg = turn_deg(solved.relative); deg < least_deg)
            least_deg = deg, from = solved.pose, positions = &solved.solution->positions;
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
    const std::optional<Solution>& solution = frames_.at(static_cast<std::size_t>(++frame_)).solution;
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

// The file: {key, budget_s, with_contact, frames: {hash of the pose: {positions, seconds, iterations, lowest_det_f,
// tips}}} as CBOR.

void SpreadReference::find_kept()
{
    kept_frames_ = nlohmann::json::object();
    if (budget_.file.empty() || !std::filesystem::exists(budget_.file)) return;
    std::vector<std::pair<Frame*, Solution>> found;
    try {
        nlohmann::json kept = nlohmann::json::from_cbor(analysis::read_text(budget_.file));
        if (kept.at("key") != budget_.key) return;
        if (const nlohmann::json& frame = kept.at("with_contact"); !frame.is_null()) {
            if (kept.at("budget_s").get<double>() < budget_.seconds) return;  // which may suffice for contact
            outcome_.not_reached = {{frame.at("frame"), frame.at("cpu_seconds"), frame.at("bone")}};
            do_without_contact();
        }
        for (Frame& frame : frames_)
            if (const auto solution = kept.at("frames").find(hash_of(frame.pose)); solution != kept.at("frames").end())
                found.emplace_back(&frame, solution_in(*solution));
        kept_frames_ = kept.at("frames");
    } catch (const nlohmann::json::exception&) {
        return warn({budget_.file + ": this file of solved frames is damaged: they are solved again"});
    }
    for (auto& [frame, solution] : found) frame->solution = std::move(solution);
    outcome_.solved = outcome_.kept = static_cast<int>(found.size());
}

SpreadReference::Solution SpreadReference::solution_in(const nlohmann::json& kept) const
{
    Solution solution;
    const std::vector<std::uint8_t>& bytes = kept.at("positions").get_binary();
    solution.positions.resize(character_->mesh.rest.rows(), 3);
    if (bytes.size() != static_cast<std::size_t>(solution.positions.size()) * sizeof(double))
        throw nlohmann::json::other_error::create(0, "another number of positions", &kept);
    std::memcpy(solution.positions.data(), bytes.data(), bytes.size());
    solution.step.seconds = kept.at("seconds");
    solution.step.iterations = kept.at("iterations");
    if (kept.contains("lowest_det_f")) solution.lowest_det_f = kept.at("lowest_det_f");
    for (const std::array<double, 4>& tip : kept.at("tips").get<std::vector<std::array<double, 4>>>())
        solution.tips.push_back({{tip[0], tip[1], tip[2]}, tip[3]});
    return solution;
}

void SpreadReference::keep()
{
    since_keeping_ = {};
    if (budget_.file.empty()) return;
    for (const Frame& frame : frames_) {
        const std::string hash = hash_of(frame.pose);
        if (!frame.solution || kept_frames_.contains(hash)) continue;
        const pbs::Positions& positions = frame.solution->positions;
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(positions.data());
        nlohmann::json& entry = kept_frames_[hash];
        entry = {{"seconds", frame.solution->step.seconds}, {"iterations", frame.solution->step.iterations}};
        entry["positions"] =
            nlohmann::json::binary({bytes, bytes + static_cast<std::size_t>(positions.size()) * sizeof(double)});
        if (frame.solution->lowest_det_f) entry["lowest_det_f"] = *frame.solution->lowest_det_f;
        entry["tips"] = nlohmann::json::array();
        for (const CreaseTip& tip : frame.solution->tips)
            entry["tips"].push_back({tip.at_rest.x(), tip.at_rest.y(), tip.at_rest.z(), tip.radius_m});
    }
    nlohmann::json kept = {
        {"key", budget_.key}, {"budget_s", budget_.seconds}, {"with_contact", nullptr}, {"frames", kept_frames_}};
    if (outcome_.with_contact) kept["with_contact"] = *outcome_.with_contact;
    const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(kept);
    analysis::write_text_atomically(budget_.file, {bytes.begin(), bytes.end()});
}

void to_json(nlohmann::json& json, const SpreadReference::NotReached& frame)
{
    json = {{"frame", frame.frame}, {"cpu_seconds", frame.seconds}, {"bone", frame.bone}};
}

void to_json(nlohmann::json& json, const SpreadReference::Outcome& outcome)
{
    json = {{"frames", outcome.frames},       {"solved", outcome.solved},         {"kept", outcome.kept},
            {"cpu_seconds", outcome.seconds}, {"contact", !outcome.with_contact}, {"not_reached", outcome.not_reached}};
}

pbs::RemarkList remarks_on(const SpreadReference::Outcome& outcome, const std::string& scene_file)
{
    pbs::RemarkList remarks;
    const auto add = [&](pbs::Gravity gravity, const std::string& text) {
        remarks.push_back({gravity, scene_file + ": " + text});
    };
    const auto held_up_by = [](const SpreadReference::NotReached& frame) {
        return frame.bone.empty() ? std::string() : fmt::format(": the flesh of {} holds it up", frame.bone);
    };
    if (const auto& frame = outcome.with_contact)
        add(pbs::Gravity::comparison_wrong,
            fmt::format(
                "the reference has no contact, for with it frame {} was not reached in {:.0f} s{}; --reference-seconds "
                "(reference.seconds) with more time, or 0 for all of it, tries again",
                frame->frame, frame->seconds, held_up_by(*frame)));
    if (!outcome.not_reached.empty()) {
        const SpreadReference::NotReached& first = outcome.not_reached.front();
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
