#include "experiments/run/spread_reference.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/run_folder.hpp"
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

constexpr int shares_of_what_is_left = 8, first_frames = 3;
constexpr double between_writings_s = 1.0;

std::string hash_of(const pbs::Pose& pose)
{
    analysis::StateHash hash;
    for (const Eigen::Isometry3d& bone : pose) hash.add_bytes(bone.data(), static_cast<std::size_t>(bone.matrix().size()) * sizeof(double));
    return hash.hex();
}

}  // namespace

int stride(int frames_left, double mean_s, double seconds_left)
{
    return std::clamp(static_cast<int>(std::ceil(std::min(1e9, frames_left * mean_s / seconds_left))), 1, std::max(1, frames_left));
}

double share_of_frame(int frames_left, double seconds_left)
{
    return seconds_left / std::clamp(frames_left, 1, shares_of_what_is_left);
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
    try {
        while (!left.empty() && has_time_left()) pass(left);
        std::vector<NotReached> again = std::exchange(outcome_.not_reached, {});
        for (; !again.empty() && has_time_left(); again.erase(again.begin()))
            solve(again.front().frame, share_of_frame(static_cast<int>(again.size()), budget_.seconds - outcome_.seconds));
        outcome_.not_reached.insert(outcome_.not_reached.end(), again.begin(), again.end());
    } catch (const Interrupted&) {
        keep();
        throw;
    }
    keep();
    progress_.reset();
}

// Once through those that are left, which loses each one that is tried.
void SpreadReference::pass(std::set<int>& left)
{
    for (auto next = left.begin(); next != left.end() && has_time_left();) {
        const auto after = [&] { return static_cast<int>(std::distance(next, left.end())); };
        solve(*next, share_of_frame(after(), budget_.seconds - outcome_.seconds));
        if (is_held_up_by_contact()) {
            do_without_contact();
            for (int number = 0; number < outcome_.frames; ++number) left.insert(number);
            next = left.begin();
            continue;
        }
        next = left.erase(next);
        if (has_time_left())
            std::advance(next, std::min(after(), stride(after(), outcome_.seconds / tried_, budget_.seconds - outcome_.seconds) - 1));
    }
}

bool SpreadReference::is_held_up_by_contact() const
{
    return options_of<FemOptions>(spec_).has_contact() && outcome_.kept == 0 && tried_ == first_frames &&
           2 * outcome_.not_reached.size() > static_cast<std::size_t>(first_frames);
}

void SpreadReference::do_without_contact()
{
    outcome_.with_contact = outcome_.not_reached.front();
    outcome_.not_reached.clear();
    outcome_.solved = outcome_.kept = tried_ = 0;
    at_ = -1;
    for (Frame& frame : frames_) frame.solution.reset();
    options_of<FemOptions>(spec_).contact = false;
    deformer_ = make_deformer(spec_);
    deformer_->reset(*character_);
}

bool SpreadReference::has_time_left() const
{
    return !outcome_.was_interrupted && outcome_.seconds < budget_.seconds;
}

void SpreadReference::solve(int number, double share_s)
{
    Frame& frame = frames_[static_cast<std::size_t>(number)];
    ++tried_;
    const double start_s = process_cpu_s();
    const auto spent_s = [&] { return process_cpu_s() - start_s; };
    deformer_->give_up_when([&] {
        progress_->advance_to(outcome_.solved, fmt::format("frames, {:.0f} of {:.0f} s", outcome_.seconds + spent_s(), budget_.seconds));
        return interrupted() || spent_s() > share_s;
    });
    continue_from_most_similar(number);
    at_ = number;
    Solution solution{.step = deformer_->advance(frame.pose, 0.0)};
    const double seconds = spent_s();
    outcome_.seconds += seconds;
    if (solution.step.outcome == pbs::Outcome::finished) {
        solution.positions = deformer_->positions();
        if (const FemFacts* facts = deformer_->facts()) solution.lowest_det_f = facts->lowest_det_f, solution.tips = facts->tips;
        frame.solution = std::move(solution);
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
    while (before >= 0 && before != at_ && !is_solved(before)) --before;
    if (before == at_) return;  // where the deformer is
    while (after < outcome_.frames && !is_solved(after)) ++after;
    pbs::Pose from(character_->skeleton.bones.size(), Eigen::Isometry3d::Identity());
    const pbs::Positions* positions = &character_->mesh.rest;
    const pbs::Pose& wanted = frames_[static_cast<std::size_t>(number)].relative;
    const auto turn_deg = [&](const pbs::Pose& pose) { return pbs::PosePath(character_->skeleton, pose, wanted).largest_turn_deg(); };
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

// The file: {key, with_contact, frames: {hash of the pose: {positions, seconds, iterations, lowest_det_f, tips}}} as CBOR.

void SpreadReference::find_kept()
{
    if (budget_.file.empty() || !std::filesystem::exists(budget_.file)) return;
    try {
        const nlohmann::json kept = nlohmann::json::from_cbor(analysis::read_text(budget_.file));
        if (kept.at("key") != budget_.key) return;
        if (const nlohmann::json& frame = kept.at("with_contact"); !frame.is_null()) {
            outcome_.not_reached = {{frame.at("frame"), frame.at("seconds"), frame.at("bone")}};
            do_without_contact();
        }
        for (Frame& frame : frames_) {
            const auto found = kept.at("frames").find(hash_of(frame.pose));
            if (found == kept.at("frames").end()) continue;
            Solution solution;
            const std::vector<std::uint8_t>& bytes = found->at("positions").get_binary();
            solution.positions.resize(character_->mesh.rest.rows(), 3);
            if (bytes.size() != static_cast<std::size_t>(solution.positions.size()) * sizeof(double)) continue;
            std::memcpy(solution.positions.data(), bytes.data(), bytes.size());
            solution.step.seconds = found->at("seconds");
            solution.step.iterations = found->at("iterations");
            if (found->contains("lowest_det_f")) solution.lowest_det_f = found->at("lowest_det_f");
            for (const std::array<double, 4>& tip : found->at("tips").get<std::vector<std::array<double, 4>>>())
                solution.tips.push_back({{tip[0], tip[1], tip[2]}, tip[3]});
            frame.solution = std::move(solution);
            ++outcome_.kept;
        }
    } catch (const nlohmann::json::exception&) {
        warn({budget_.file + ": this file of solved frames is damaged: its frames are solved again"});
    }
    outcome_.solved = outcome_.kept;
}

void SpreadReference::keep()
{
    since_keeping_ = {};
    if (budget_.file.empty() || outcome_.solved == outcome_.kept) return;
    nlohmann::json kept = {{"key", budget_.key}, {"frames", nlohmann::json::object()}, {"with_contact", nullptr}};
    if (const auto& frame = outcome_.with_contact)
        kept["with_contact"] = {{"frame", frame->frame}, {"seconds", frame->seconds}, {"bone", frame->bone}};
    for (const Frame& frame : frames_) {
        if (!frame.solution) continue;
        const pbs::Positions& positions = frame.solution->positions;
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(positions.data());
        nlohmann::json& one = kept["frames"][hash_of(frame.pose)];
        one = {{"seconds", frame.solution->step.seconds}, {"iterations", frame.solution->step.iterations}};
        one["positions"] = nlohmann::json::binary({bytes, bytes + static_cast<std::size_t>(positions.size()) * sizeof(double)});
        if (frame.solution->lowest_det_f) one["lowest_det_f"] = *frame.solution->lowest_det_f;
        one["tips"] = nlohmann::json::array();
        for (const CreaseTip& tip : frame.solution->tips)
            one["tips"].push_back({tip.at_rest.x(), tip.at_rest.y(), tip.at_rest.z(), tip.radius_m});
    }
    const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(kept);
    analysis::write_text_atomically(budget_.file, {bytes.begin(), bytes.end()});
}

}  // namespace experiments
