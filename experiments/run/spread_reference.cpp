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
#include <limits>
#include <utility>

namespace experiments {
namespace {

constexpr int frames_with_equal_shares = 8;
constexpr double longest_over_median = 3.0, between_writings_s = 1.0;
constexpr int first_frames_with_contact = 4, most_steps_with_contact = 120;

std::string hash_of(const pbs::Pose& pose)
{
    analysis::StateHash hash;
    for (const Eigen::Isometry3d& bone : pose) hash.add_bytes(bone.data(), static_cast<std::size_t>(bone.matrix().size()) * sizeof(double));
    return hash.hex();
}

}  // namespace

std::vector<int> spread_order(int frames)
{
    std::vector<int> order;
    std::vector<bool> is_taken(static_cast<std::size_t>(frames), false);
    const auto take = [&](int frame) {
        if (!is_taken[static_cast<std::size_t>(frame)]) order.push_back(frame);
        is_taken[static_cast<std::size_t>(frame)] = true;
    };
    take(0);
    take(frames - 1);
    for (unsigned k = 1; static_cast<int>(order.size()) < frames; ++k) {
        double fraction = 0.0, digit = 0.5;
        for (unsigned bits = k; bits > 0; bits /= 2, digit /= 2.0) fraction += (bits % 2) * digit;
        take(static_cast<int>(std::lround(fraction * (frames - 1))));
    }
    return order;
}

double share_of_frame(double seconds_left, int frames, int tried, const std::vector<double>& reached_s)
{
    const int first = std::min(frames, frames_with_equal_shares);
    if (tried < first) return seconds_left / (first - tried);
    const double usual_s = reached_s.empty() ? 0.0 : longest_over_median * analysis::median(reached_s);
    return std::min(seconds_left, std::max(usual_s, seconds_left / std::max(1, frames - tried)));
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
    reached_s_.clear();
    tried_ = 0;
    frame_ = -1;
    outcome_ = {};
}

void SpreadReference::foresee(const std::vector<pbs::Pose>& poses)
{
    for (const pbs::Pose& pose : poses) frames_.push_back({pose, pbs::RootFrame(character_->skeleton, pose).pose()});
    outcome_.frames = static_cast<int>(frames_.size());
    find_kept();
    progress_.emplace("reference", outcome_.frames);
    try {
        solve_all();
    } catch (const Interrupted&) {
        keep();
        throw;
    }
    keep();
    progress_.reset();
}

void SpreadReference::solve_all()
{
    const auto is_solved = [&](int frame) { return frames_[static_cast<std::size_t>(frame)].solution.has_value(); };
    const std::vector<int> order = spread_order(outcome_.frames);
    for (int next = 0; next < outcome_.frames && has_time_left(); ++next) {
        if (is_solved(order[static_cast<std::size_t>(next)])) continue;
        solve(order[static_cast<std::size_t>(next)]);
        if (!tries_contact() || outcome_.not_reached.empty()) continue;
        do_without_contact();
        next = -1;
    }
    for (const NotReached& earlier : std::exchange(outcome_.not_reached, {}))
        if (has_time_left())
            solve(earlier.frame);
        else
            outcome_.not_reached.push_back(earlier);
}

bool SpreadReference::tries_contact() const
{
    return options_of<FemOptions>(spec_).has_contact() && outcome_.kept + tried_ <= first_frames_with_contact;
}

void SpreadReference::do_without_contact()
{
    outcome_.with_contact = outcome_.not_reached.front();
    outcome_.not_reached.clear();
    outcome_.solved = outcome_.kept = tried_ = 0;
    reached_s_.clear();
    for (Frame& frame : frames_) frame.solution.reset();
    options_of<FemOptions>(spec_).contact = false;
    deformer_ = make_deformer(spec_);
    deformer_->reset(*character_);
}

bool SpreadReference::has_time_left() const
{
    return !outcome_.was_interrupted && outcome_.seconds < budget_.seconds;
}

void SpreadReference::solve(int number)
{
    Frame& frame = frames_[static_cast<std::size_t>(number)];
    const double share_s = share_of_frame(budget_.seconds - outcome_.seconds, outcome_.frames, outcome_.kept + tried_, reached_s_);
    ++tried_;
    const int most_steps = tries_contact() ? most_steps_with_contact : std::numeric_limits<int>::max();
    int steps = 0;
    const double start_s = process_cpu_s();
    const auto spent_s = [&] { return process_cpu_s() - start_s; };
    deformer_->give_up_when([&] {
        progress_->advance_to(outcome_.solved, fmt::format("frames, {:.0f} of {:.0f} s", outcome_.seconds + spent_s(), budget_.seconds));
        return interrupted() || spent_s() > share_s || ++steps > most_steps;
    });
    continue_from_most_similar(number);
    Solution solution{.step = deformer_->advance(frame.pose, 0.0)};
    const double seconds = spent_s();
    outcome_.seconds += seconds;
    if (solution.step.outcome == pbs::Outcome::finished) {
        solution.positions = deformer_->positions();
        if (const FemFacts* facts = deformer_->facts()) solution.lowest_det_f = facts->lowest_det_f, solution.tips = facts->tips;
        frame.solution = std::move(solution);
        reached_s_.push_back(seconds);
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
    const pbs::Pose at_rest(character_->skeleton.bones.size(), Eigen::Isometry3d::Identity());
    const pbs::Pose& wanted = frames_[static_cast<std::size_t>(number)].relative;
    const auto turn_deg = [&](const pbs::Pose& from) { return pbs::PosePath(character_->skeleton, from, wanted).largest_turn_deg(); };
    const Frame* nearest = nullptr;
    double least_deg = turn_deg(at_rest);
    for (const int step : {-1, 1}) {
        int other = number + step;
        while (other >= 0 && other < outcome_.frames && !frames_[static_cast<std::size_t>(other)].solution) other += step;
        if (other < 0 || other >= outcome_.frames) continue;
        const Frame& solved = frames_[static_cast<std::size_t>(other)];
        if (const double deg = turn_deg(solved.relative); deg < least_deg) nearest = &solved, least_deg = deg;
    }
    if (nearest)
        deformer_->continue_from(nearest->pose, nearest->solution->positions);
    else
        deformer_->continue_from(at_rest, character_->mesh.rest);
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
