#include "experiments/studies/work_precision/measuring.hpp"

#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/metrics/skin_error.hpp"
#include "analysis/statistics/paired_comparison.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/correctives.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/kept_references.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

namespace experiments {

using analysis::Columns;

Columns<MemberErrors> member_error_columns()
{
    Columns<MemberErrors> columns;
    const std::vector<EnsembleMember> members = family();
    for (std::size_t m = 0; m < members.size(); ++m)
        columns.emplace_back(
            members[m].name + "_pct", [m](auto& errors) -> auto& { return errors[m]; });
    return columns;
}

const Columns<PointRow> point_columns = MEMBER_COLUMNS(PointRow, pose, body, stratum, method, flesh, setting, outcome,
                                                       ms, times_pbs, clock, skin_mm, inverted) +
                                        analysis::within(&PointRow::errors, member_error_columns());
const std::vector<std::string> played_columns = {"pose",   "clip", "method",          "setting", "start",
                                                 "member", "ms",   "error_joint_pct", "skin_mm"};

namespace {

constexpr int frames_of_memory = 24;  // before the pose
constexpr int played_frames = 120;    // before a frame that is compared: two seconds
constexpr double played_rate_hz = 60.0;
constexpr std::size_t first_poses = 4;  // of the quick answer on deformers of the user's own

struct ComparedPose {
    const ReferencePose* pose;
    pbs::Pose bones,
        neighbour;  // neighbour: of the frame before, or the one after; timed frames take turns between the two
    std::vector<pbs::Pose> way;  // the frames before, for a deformer with memory
    KeptReferences kept;
};

// The shapes of one setting in all poses.
struct PosedShapes {
    std::vector<pbs::Positions> shapes;  // [m], of each pose
    std::vector<double> ms;              // of each pose; empty: not timed
    double baseline_ms = 0.0;
    FrameClock clock = FrameClock::processor;

    double slowest_ms() const { return ms.empty() ? 0.0 : *std::ranges::max_element(ms); }
};

// A body with its references, and the deformers that are posed like them.
class ComparedBody {
public:
    explicit ComparedBody(const ComparisonCase& comparison)
        : of_(comparison),
          scene_(comparison.poses.front().scene),
          character_(pbs::make_character(scene_.character)),
          errors_(error_domain(character_, {})),
          skin_(character_.mesh.rest, character_.mesh.tets),
          metrics_(character_.mesh.rest, character_.mesh.tets)
    {
        for (const ReferencePose& pose : comparison.poses) {
            const pbs::Motion motion = make_motion(pose.scene.motion, character_.skeleton, pose.scene.file);
            const auto frame = [&](int f) {
                return motion.steps.at(static_cast<std::size_t>(f) * motion.steps_per_frame);
            };
            const pbs::Pose bones = frame(pose.frame);
            ComparedPose& compared =
                poses_.emplace_back(ComparedPose{.pose = &pose,
                                                 .bones = bones,
                                                 .neighbour = frame(pose.frame > 0 ? pose.frame - 1 : 1),
                                                 .way = {},
                                                 .kept = read_references(pose.name, character_, bones)});
            for (int f = std::max(0, pose.frame - frames_of_memory); f < pose.frame; ++f)
                compared.way.push_back(frame(f));
        }
        const ComparedMethod pbs{
            .name = "pbs",
            .kind = "pbs",
            .overrides = {fmt::format("pbs.iterations={}", paper_iterations), "pbs.order=plain", "pbs.precision=f64"}};
        baseline_ = make_deformer(spec_of({&pbs}, scene_, character_, family().front()));
        baseline_->reset(character_);
    }

    const Scene& scene() const { return scene_; }
    const pbs::Character& character() const { return character_; }
    const std::vector<ComparedPose>& poses() const { return poses_; }
    DeformerSpec spec(const Setting& setting, const EnsembleMember& member) const
    {
        return spec_of(setting, scene_, character_, member);
    }

    // only: the poses by name; empty: all.
    PosedShapes posed(const DeformerSpec& spec, bool timed, const std::set<std::string>& only = {}) const
    {
        const std::unique_ptr<Deformer> deformer = make_deformer(spec);
        deformer->reset(character_);
        const bool has_own_clock = traits_of(spec).has_own_clock;
        const int rounds = timed ? of_.rounds : 0;
        if (has_own_clock) deformer->foresee(coming(*deformer, rounds, only));
        PosedShapes posed;
        for (const ComparedPose& pose : poses_) {
            if (!only.empty() && !only.contains(pose.pose->name)) {
                posed.shapes.emplace_back();
                continue;
            }
            if (deformer->has_memory())
                for (const pbs::Pose& before : pose.way) deformer->advance(before, scene_.motion.time_step_s);
            deformer->advance(pose.bones, scene_.motion.time_step_s);
            posed.shapes.push_back(deformer->positions());
            std::vector<double> samples_ms;
            for (int round = 0; round < rounds; ++round)
                samples_ms.push_back(frame_ms(*deformer, turn(pose, round), has_own_clock));
            if (timed) posed.ms.push_back(analysis::median(samples_ms));
        }
        if (timed) posed.baseline_ms = baseline_ms();
        if (has_own_clock)
            posed.clock = deformer->record().value("own_times", false) ? FrameClock::own : FrameClock::wall;
        return posed;
    }

    // A row without errors. pose: its place among the poses.
    PointRow row(std::size_t pose, const std::string& method, GivenFlesh flesh, const std::string& setting,
                 const PosedShapes& posed) const
    {
        const ReferencePose& reference_pose = *poses_[pose].pose;
        PointRow row{.pose = reference_pose.name,
                     .body = reference_pose.of.body,
                     .stratum = reference_pose.stratum,
                     .method = method,
                     .flesh = flesh,
                     .setting = setting};
        const pbs::Positions& shape = posed.shapes[pose];
        row.outcome = shape.allFinite() ? "finished" : "not_finite";
        row.clock = posed.clock;
        if (pose < posed.ms.size()) {
            row.ms = posed.ms[pose];
            row.times_pbs = posed.ms[pose] / posed.baseline_ms;
        }
        if (shape.allFinite()) row.inverted = metrics_.measure(shape).inverted_tets;
        return row;
    }

    std::optional<double> error_joint_pct(std::size_t pose, std::size_t member, const pbs::Positions& shape) const
    {
        const KeptReference* reference = poses_[pose].kept.find(family()[member].name);
        if (!reference || !reference->is_reached() || !shape.allFinite()) return std::nullopt;
        return errors_.measure(shape, reference->positions, reference->at_tips).joint_pct;
    }
    std::optional<double> skin_mm(std::size_t pose, std::size_t member, const pbs::Positions& shape) const
    {
        const KeptReference* reference = poses_[pose].kept.find(family()[member].name);
        if (!reference || !reference->is_reached() || !shape.allFinite()) return std::nullopt;
        return skin_.measure(shape, reference->positions, reference->at_tips).rms_mm;
    }

    // shape_for(member): the shape that is compared with this member; null: none.
    template <typename ShapeFor>
    void add_errors(PointRow& row, std::size_t pose, const ShapeFor& shape_for) const
    {
        std::vector<double> mm;
        for (std::size_t m = 0; m < members_of_family; ++m) {
            const pbs::Positions* shape = shape_for(m);
            if (!shape) continue;
            row.errors[m] = error_joint_pct(pose, m, *shape);
            if (const auto skin = skin_mm(pose, m, *shape)) mm.push_back(*skin);
        }
        if (!mm.empty()) row.skin_mm = analysis::median(mm);
    }

private:
    static const pbs::Pose& turn(const ComparedPose& pose, int round)
    {
        return round % 2 == 0 ? pose.neighbour : pose.bones;
    }

    double frame_ms(Deformer& deformer, const pbs::Pose& bones, bool has_own_clock) const
    {
        const double start_s = process_cpu_s();
        const pbs::StepSummary step = deformer.advance(bones, scene_.motion.time_step_s);
        return 1e3 * (has_own_clock ? step.seconds : process_cpu_s() - start_s);
    }

    double baseline_ms() const
    {
        std::vector<double> samples_ms;
        for (int round = 0; round < of_.rounds; ++round)
            samples_ms.push_back(frame_ms(*baseline_, turn(poses_.front(), round), false));
        return analysis::median(samples_ms);
    }

    std::vector<pbs::Pose> coming(const Deformer& deformer, int rounds, const std::set<std::string>& only) const
    {
        std::vector<pbs::Pose> coming;
        for (const ComparedPose& pose : poses_) {
            if (!only.empty() && !only.contains(pose.pose->name)) continue;
            if (deformer.has_memory()) coming.insert(coming.end(), pose.way.begin(), pose.way.end());
            coming.push_back(pose.bones);
            for (int round = 0; round < rounds; ++round) coming.push_back(turn(pose, round));
        }
        return coming;
    }

    const ComparisonCase& of_;
    Scene scene_;
    pbs::Character character_;
    std::vector<ComparedPose> poses_;
    analysis::ErrorMetrics errors_;
    analysis::SkinErrorMetrics skin_;
    analysis::MeshMetrics metrics_;
    std::unique_ptr<Deformer> baseline_;
};

// Every setting with the flesh of the training members. A ladder of iterations ends where it takes longer than the
// largest budget.
void train(const ComparedBody& body, Measurements& measurements)
{
    const double longest_ms = comparison_times().budgets_ms.back();
    const std::vector<EnsembleMember> members = family(), fleshes = training_members();
    for (const ComparedMethod& method : methods())
        for (const KeyValues& of_grid : method.grid)
            for (const Setting& setting : tried_settings(method, of_grid)) {
                std::map<std::string, PosedShapes> with_flesh;  // by member
                for (const EnsembleMember& member : fleshes)
                    if (method.takes_flesh() || with_flesh.empty())
                        with_flesh.emplace(member.name, body.posed(body.spec(setting, member), with_flesh.empty()));
                const PosedShapes& timed = with_flesh.contains(fleshes.front().name)
                                               ? with_flesh.at(fleshes.front().name)
                                               : with_flesh.begin()->second;
                for (std::size_t pose = 0; pose < body.poses().size(); ++pose) {
                    PointRow row =
                        body.row(pose, method.name, method.takes_flesh() ? GivenFlesh::own : GivenFlesh::none,
                                 setting.text(), timed);
                    body.add_errors(row, pose, [&](std::size_t m) -> const pbs::Positions* {
                        if (std::ranges::count(fleshes, members[m].name, &EnsembleMember::name) == 0) return nullptr;
                        const auto own = with_flesh.find(members[m].name);
                        return &(own == with_flesh.end() ? timed : own->second).shapes[pose];
                    });
                    measurements.points.push_back(std::move(row));
                }
                if (timed.slowest_ms() > longest_ms) break;
            }
}

// The chosen settings of a method, each once.
std::vector<Setting> settings_of(const ComparisonCase& comparison, const ComparedMethod& method)
{
    std::vector<Setting> settings;
    std::set<std::string> seen;
    for (const ChosenSetting& chosen : comparison.settings)
        if (chosen.method == method.name && seen.insert(chosen.setting).second)
            settings.push_back({&method, keys_in(chosen.setting)});
    return settings;
}

// PBS, LBS and deformers of the user's own must be finite; another method that is not has no error there.
void note_breakdown(const DeformerSpec& spec, const PosedShapes& posed, Measurements& measurements)
{
    const bool must_be_finite =
        options_if<ExternalOptions>(spec) || options_if<pbs::PbsOptions>(spec) || traits_of(spec).blends_linearly;
    const auto is_finite = [](const pbs::Positions& shape) { return shape.allFinite(); };
    if (must_be_finite && !std::ranges::all_of(posed.shapes, is_finite))
        measurements.breakdown += spec.label + " is not finite. ";
}

void evaluate(const ComparedBody& body, const Setting& setting, Measurements& measurements)
{
    const ComparedMethod& method = *setting.method;
    std::vector<PosedShapes> with_flesh;  // of each member, or one
    for (const EnsembleMember& member : family())
        if (method.takes_flesh() || with_flesh.empty())
            with_flesh.push_back(body.posed(body.spec(setting, member), with_flesh.empty()));
    note_breakdown(body.spec(setting, family().front()), with_flesh.front(), measurements);
    for (std::size_t pose = 0; pose < body.poses().size(); ++pose) {
        const auto add = [&](GivenFlesh flesh, const auto& place) {
            PointRow row = body.row(pose, method.name, flesh, setting.text(), with_flesh.front());
            body.add_errors(row, pose, [&](std::size_t m) { return &with_flesh[place(m)].shapes[pose]; });
            measurements.points.push_back(std::move(row));
        };
        const auto first = [](std::size_t) { return std::size_t{0}; };
        if (!method.takes_flesh()) add(GivenFlesh::none, first);
        if (!method.takes_flesh()) continue;
        add(GivenFlesh::own, [](std::size_t m) { return m; });
        add(GivenFlesh::standard, first);
    }
}

// Against the first member, whose flesh they have.
void evaluate_starts(const ComparisonCase& comparison, const ComparedBody& body, Measurements& measurements)
{
    const std::vector<std::string> names = start_poses();
    const std::set<std::string> only(names.begin(), names.end());
    for (const OtherStart& start : other_starts()) {
        const ComparedMethod& method = *std::ranges::find(methods(), start.of, &ComparedMethod::name);
        for (Setting setting : settings_of(comparison, method)) {
            const std::string text = setting.text();
            setting.keys.insert(setting.keys.end(), start.overrides.begin(), start.overrides.end());
            const PosedShapes posed = body.posed(body.spec(setting, family().front()), false, only);
            for (std::size_t pose = 0; pose < body.poses().size(); ++pose) {
                if (posed.shapes[pose].size() == 0) continue;
                PointRow row = body.row(pose, start.name, GivenFlesh::start, text, posed);
                body.add_errors(row, pose, [&](std::size_t m) { return m == 0 ? &posed.shapes[pose] : nullptr; });
                measurements.points.push_back(std::move(row));
            }
        }
    }
}

// Two seconds of a clip that end in a compared pose, at 60 frames per second.
pbs::Motion played_motion(const ComparisonCase& comparison, const pbs::Skeleton& skeleton)
{
    const Scene scene = read_scene(
        "human_01_01", {"motion.clip=" + comparison.clip + ".bvh", fmt::format("motion.rate_hz={}", played_rate_hz),
                        fmt::format("pbs.time_step_s={:.17g}", 1.0 / played_rate_hz)});
    return make_motion(scene.motion, skeleton, scene.file);
}

void play(const ComparisonCase& comparison, const ComparedBody& body, const Setting& setting, const pbs::Motion& motion,
          Measurements& measurements)
{
    const std::vector<EnsembleMember> members = family();
    std::map<std::string, std::unique_ptr<Deformer>> deformers;
    for (std::size_t m = 0; m < members.size(); ++m) {
        if (!is_played(members[m])) continue;
        const std::unique_ptr<Deformer> deformer = make_deformer(body.spec(setting, members[m]));
        deformer->reset(body.character());
        for (std::size_t pose = 0; pose < body.poses().size(); ++pose) {
            const ReferencePose& reference = *body.poses()[pose].pose;
            const int last =
                static_cast<int>(std::lround(reference.frame * played_rate_hz / reference.scene.motion.rate_hz));
            const auto add = [&](FrameGuess start, const std::vector<double>& samples_ms) {
                measurements.played.add_row({reference.name, comparison.clip, setting.method->name, setting.text(),
                                             start, members[m].name, analysis::median(samples_ms),
                                             body.error_joint_pct(pose, m, deformer->positions()),
                                             body.skin_mm(pose, m, deformer->positions())});
            };
            std::vector<double> samples_ms;
            for (int frame = std::max(0, last - played_frames); frame <= last; ++frame) {
                const double start_s = process_cpu_s();
                if (!samples_ms.empty())
                    deformer->start_from(carried_by_lbs(deformer->positions(), body.character(),
                                                        motion.steps[frame - 1], motion.steps[frame]));
                deformer->advance(motion.steps[frame], motion.time_step_s);
                samples_ms.push_back(1e3 * (process_cpu_s() - start_s));
            }
            add(FrameGuess::frame_before, samples_ms);
            deformer->advance(motion.steps[last], motion.time_step_s);
            add(FrameGuess::cold, samples_ms);
        }
    }
}

// A quick answer before the whole: what the deformers of the user's own leave of LBS's error in the first poses by
// movement, against the first reference variant, with the quick methods of the longest time for comparison.
void print_first_answers(const ComparisonCase& comparison, const ComparedBody& body)
{
    std::vector<std::size_t> places;
    std::set<std::string> only;
    for (std::size_t pose = 0; pose < body.poses().size() && places.size() < first_poses; ++pose)
        if (body.poses()[pose].pose->stratum == Stratum::movement) {
            places.push_back(pose);
            only.insert(body.poses()[pose].pose->name);
        }
    const auto errors_pct = [&](const PosedShapes& posed) {
        std::vector<double> errors;
        for (const std::size_t pose : places)
            errors.push_back(body.error_joint_pct(pose, 0, posed.shapes[pose]).value_or(analysis::not_known));
        return errors;
    };
    std::map<std::string, std::vector<double>> familiar;
    for (const char* name : {"lbs", "dqs", "delta_mush"})
        for (const Setting& setting :
             settings_of(comparison, *std::ranges::find(methods(), name, &ComparedMethod::name)))
            familiar[name] = errors_pct(body.posed(body.spec(setting, family().front()), false, only));
    const std::vector<double>& lbs = familiar["lbs"];
    if (lbs.empty()) return;
    for (const ComparedMethod& method : comparison.external) {
        const PosedShapes posed = body.posed(body.spec({&method}, family().front()), true, only);
        std::string others;
        for (const auto& [name, title] : {std::pair("dqs", "DQS"), std::pair("delta_mush", "delta mush")})
            if (!familiar[name].empty())
                others += fmt::format("; {} {:.0f} %", title, 100.0 * analysis::share(familiar[name], lbs));
        const double share = analysis::share(errors_pct(posed), lbs);
        spdlog::info("first answer, {} poses of {}: {}: {:.3g} ms per frame, {}{}", places.size(), comparison.body,
                     method.name, analysis::median(posed.ms),
                     std::isfinite(share) ? fmt::format("{:.0f} % of LBS's error", 100.0 * share)
                                          : "no error: its positions are not finite in at least one pose",
                     others);
    }
}

}  // namespace

nlohmann::json to_json(const ComparisonCase& comparison)
{
    nlohmann::json json = {{"name", comparison.name},
                           {"body", comparison.body},
                           {"what", name_of(comparison.what)},
                           {"clip", comparison.clip},
                           {"rounds", comparison.rounds}};
    for (const ReferencePose& pose : comparison.poses) json["poses"].push_back(to_json(pose));
    for (const ChosenSetting& chosen : comparison.settings)
        json["settings"].push_back({chosen.budget_ms, chosen.method, chosen.setting});
    for (const ComparedMethod& method : comparison.external) json["external"].push_back(to_json(method.external));
    json["methods"] = cases_document("work_precision");
    for (const ComparedMethod& method : methods())
        if (method.is_learned() && std::filesystem::exists(file_of_correctives(comparison.body)))
            json["learned"][method.name] = to_json(kept_correctives(comparison.body));
    return json;
}

Measurements measure(const ComparisonCase& comparison)
{
    const ComparedBody body(comparison);
    Measurements measurements;
    if (!comparison.external.empty()) print_first_answers(comparison, body);
    for (const ComparedMethod& method : comparison.external) evaluate(body, {&method}, measurements);
    if (comparison.what == Measured::training) train(body, measurements);
    std::optional<pbs::Motion> motion;
    if (comparison.what == Measured::played) motion = played_motion(comparison, body.character().skeleton);
    for (const ComparedMethod& method : methods())
        for (const Setting& setting : settings_of(comparison, method)) {
            if (comparison.what == Measured::evaluation) evaluate(body, setting, measurements);
            if (comparison.what == Measured::played) play(comparison, body, setting, *motion, measurements);
        }
    if (comparison.what == Measured::evaluation) evaluate_starts(comparison, body, measurements);
    return measurements;
}

}  // namespace experiments
