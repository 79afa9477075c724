#include "experiments/studies/work_precision/measured_points.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>

namespace experiments {
namespace {

// The digest of a case's settings, which takes tenths of a second and is the same for all poses of a scene with the same range.
nlohmann::json digest_of_points(const WorkPrecisionCase& of)
{
    thread_local std::map<std::string, std::string> known;
    std::string& digest = known[of.scene.name + to_json(reference_flesh(of.scene)).dump() + to_json(of.range).dump()];
    if (digest.empty()) digest = digest_of(settings_of(of.scene, of.range));
    return digest;
}

}  // namespace

RECORD_SETTINGS_AND(WorkPrecisionCase,
                    .derived("points", digest_of_points)
                        .derived("reference", [](const WorkPrecisionCase& one) { return to_json(reference_flesh(one.scene)); }),
                    of, scene, frame, half, range, rounds, newton_rounds, reference_is_refined, members, longest_frame_ms, external)

namespace {

// A setting's shape in the case's pose.
struct ReachedPoint {
    const Setting* setting = nullptr;
    const BodyMesh* mesh = nullptr;
    Shape shape;             // on its own mesh
    pbs::Positions on_base;  // on the case's own vertices
};

PointRow row_on(const Setting& setting, const BodyMesh& mesh)
{
    PointRow row{.key = key_of(setting)};
    row.is_external = setting.is_external();
    row.vertices = int(mesh.character().mesh.rest.rows());
    row.tets = int(mesh.character().mesh.tets.rows());
    return row;
}

// States the reference, and whether the error, if there is one, is below its bound.
void add_reference(PointRow& row, const PosedReference& reference)
{
    row.masked_share_pct = reference.masked_share_pct();
    if (!reference.is_reached()) return;
    row.reference = reference.label();
    if (!std::isfinite(reference.bound().joint_pct)) return;
    row.reference_error_joint_pct = reference.bound().joint_pct;
    if (row.error) row.below_reference_error = row.error->joint_pct <= *row.reference_error_joint_pct;
}

PointRow row_without_answer(const Setting& setting, const BodyMesh& mesh, const std::string& outcome, const std::string& reason)
{
    PointRow row = row_on(setting, mesh);
    row.outcome = outcome;
    row.reason = reason;
    return row;
}

// The rows of points.csv: of a setting that reached the pose, of one without an answer (outcome is over_time_limit or not_applicable), and
// of the reference itself (outcome is reference, or not_reached).
PointRow point_row(const ReachedPoint& point)
{
    PointRow row = row_on(*point.setting, *point.mesh);
    row.outcome = point.shape.finished ? "finished" : point.shape.positions.allFinite() ? "not_converged" : "not_finite";
    row.reach_ms = 1e3 * point.shape.seconds;
    const pbs::TetMesh& mesh = point.mesh->character().mesh;
    row.metrics = analysis::MeshMetrics(mesh.rest, mesh.tets).measure(point.shape.positions);
    return row;
}

PointRow reference_row(const pbs::TetMesh& mesh, const PosedReference& reference)
{
    const NestedSolution& solution = reference.is_reached() ? reference.reference() : reference.solutions().front();
    PointRow row{.key = {.deformer = "reference", .element_order = solution.element_order, .refined = solution.refinements > 0}};
    row.vertices = solution.vertices;
    row.tets = solution.tets;
    row.outcome = reference.is_reached() ? "reference" : "not_reached";
    row.reason = reference.why_not_reached();
    for (const NestedSolution& one : reference.solutions()) row.reach_ms += 1e3 * one.seconds;
    row.metrics = analysis::MeshMetrics(mesh.rest, mesh.tets).measure(solution.positions);
    add_reference(row, reference);
    return row;
}

// The references of one case: the first member of the family (shared/posed_reference.hpp) and further ones. The character outlives it.
class ReferenceSet {
public:
    ReferenceSet(const WorkPrecisionCase& of, const pbs::Character& character, const PosePair& poses, const std::string& solutions)
        : of_(of),
          skin_(character.mesh.rest, character.mesh.tets),
          first_(character, reference_flesh(of.scene), poses.pose, poses.time_step_s,
                 of.reference_is_refined ? ReferenceEffort::other_tets : ReferenceEffort::own_tets, solutions)
    {
        for (const EnsembleMember& member : of.members) {
            members_.emplace_back(character, flesh_of(reference_flesh(of.scene), member), poses.pose, poses.time_step_s,
                                  ReferenceEffort::own_tets, solutions);
            members_.back().take_bound_of(first_);
        }
    }

    const PosedReference& first() const { return first_; }

    RecordedShapes no_shapes() const
    {
        std::vector<Eigen::VectorXd> weights(1 + further_members);
        if (first_.is_reached()) weights[0] = first_.joint_weights();
        for (std::size_t m = 0; m < members_.size(); ++m)
            if (members_[m].is_reached()) weights[1 + place_among_further(of_.members[m].name)] = members_[m].joint_weights();
        return RecordedShapes(weights);
    }

    // The errors of these positions of the case's own vertices [m], #V x 3, against each reference that was reached.
    void add_errors(PointRow& row, const pbs::Positions& positions) const
    {
        if (first_.is_reached()) {
            row.error = first_.error_of(positions);
            row.skin = skin_.measure(positions, first_.reference().positions, first_.masked());
        }
        for (std::size_t m = 0; m < members_.size(); ++m)
            if (members_[m].is_reached())
                row.members.at(place_among_further(of_.members[m].name)) = members_[m].error_of(positions).joint_pct;
    }

    // The reference and its bound as changes.csv states them.
    void set_reference_of_change(PointRow& row) const
    {
        if (!first_.is_reached()) {
            row.reference = "not_reached";
            return;
        }
        const NestedSolution& used = first_.reference();
        row.reference = std::string(used.element_order == 2 ? "quadratic" : "linear") + (used.refinements > 0          ? "_refined"
                                                                                         : used.edges_per_radius > 0.0 ? "_graded"
                                                                                                                       : "");
        if (row.reference_error_joint_pct || of_.reference_is_refined || used.element_order != 2) return;
        for (const NestedSolution& solution : first_.solutions())
            if (solution.finished && solution.element_order == 1)
                row.reference_error_joint_pct = first_.error_of(solution.positions).joint_pct;
    }

    std::vector<FamilyRow> member_rows() const
    {
        std::vector<FamilyRow> rows;
        for (std::size_t m = 0; m < members_.size(); ++m) {
            const PosedReference& one = members_[m];
            const double bound_pct = one.bound().joint_pct;
            rows.push_back({of_.of, of_.members[m], one.is_reached() ? "reached" : "not_reached",
                            std::isfinite(bound_pct) ? std::optional(bound_pct) : std::nullopt, one.masked_share_pct()});
            for (const NestedSolution& solution : one.solutions()) rows.back().solve_s += solution.seconds;
        }
        return rows;
    }

private:
    const WorkPrecisionCase& of_;
    analysis::SkinErrorMetrics skin_;
    PosedReference first_;
    std::deque<PosedReference> members_;  // of_.members
};

std::vector<double> edge_lengths_m(const pbs::TetMesh& mesh)
{
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    std::vector<double> lengths;
    for (const auto edge : edges.rowwise()) lengths.push_back((mesh.rest.row(edge(0)) - mesh.rest.row(edge(1))).norm());
    return lengths;
}

constexpr int frames_of_memory = 24;  // before the pose

// The two poses of a timed frame, on the case's skeleton.
PosePair poses_of(const WorkPrecisionCase& of, const pbs::Skeleton& skeleton)
{
    const pbs::Motion motion = make_motion(of.scene.motion, skeleton, of.scene.file);
    const auto pose = [&](int frame) { return motion.steps.at(static_cast<std::size_t>(frame) * motion.steps_per_frame); };
    PosePair poses{pose(of.frame), pose(of.frame > 0 ? of.frame - 1 : of.frame + 1), motion.time_step_s};
    for (int frame = std::max(0, of.frame - frames_of_memory); frame < of.frame; ++frame) poses.way.push_back(pose(frame));
    return poses;
}

class CaseMeasuring {
public:
    CaseMeasuring(const WorkPrecisionCase& of, const std::string& solutions)
        : of_(of),
          solutions_(solutions),
          base_(std::make_shared<pbs::Character>(pbs::make_character(of.scene.character))),
          poses_(poses_of(of, base_->skeleton))
    {
        for (const DeformerSpec& spec : of.external) external_.push_back({spec.name, spec});
        meshes_.emplace(0, BodyMesh(base_));
    }

    // The user's programs are called first, so that one that fails ends the run at once.
    MeasuredPoints measure()
    {
        for (const Setting& setting : external_) reach(setting);
        references_.emplace(of_, *base_, poses_, solutions_);
        measured_.shapes = references_->no_shapes();
        add_other_meshes();
        compared_ = settings_of(of_.scene, of_.range);
        for (Setting& setting : compared_) {
            if (setting.change && setting.change->k_by_edge_length) {
                auto& options = options_of<pbs::PbsOptions>(setting.spec);
                options.k_stretch_length_m = neutral_length(options.k_stretch, edge_lengths_m(base_->mesh));
            }
            reach(setting);
        }
        const std::vector<std::vector<double>> samples_ms = time_all();
        for (std::size_t i = 0; i < points_.size(); ++i) add_row(points_[i], deformers_[i], samples_ms[i]);
        add_row_of_case(reference_row(base_->mesh, references_->first()));
        measured_.members = references_->member_rows();
        return measured_;
    }

private:
    void add_other_meshes()
    {
        if (of_.range.refined) meshes_.emplace(refined, BodyMesh::refined(*base_));
        if (of_.range.changes) meshes_.emplace(smooth_weights, BodyMesh::with_smooth_weights(*base_));
        for (const std::vector<int>* sizes : {&of_.range.other_vertices, &of_.range.without_fem})
            for (const int vertices : *sizes) meshes_.emplace(vertices, BodyMesh(of_.scene.character, vertices, *base_));
    }

    // Null where it was not reached.
    const ReachedPoint* limit_of_deformers() const
    {
        const auto found = std::ranges::find_if(points_, [](const auto& point) { return point.setting->is_limit_of_deformers(); });
        return found != points_.end() && found->shape.finished ? &*found : nullptr;
    }

    // A ladder ends at the first setting that takes too long.
    void reach(const Setting& setting)
    {
        stop_if_interrupted();
        const bool is_smooth = setting.change && setting.change->smooth_weights;
        const BodyMesh& mesh = meshes_.at(setting.refined ? refined : is_smooth ? smooth_weights : setting.vertices);
        SettingKey ladder = key_of(setting);
        ladder.iterations.reset();
        ladder.substeps.reset();
        if (const auto slow = too_slow_.find(ladder); slow != too_slow_.end()) {
            const std::string why = fmt::format("{:.0f} ms with the setting before, {:g} ms allowed", slow->second, of_.longest_frame_ms);
            return add_row_of_case(row_without_answer(setting, mesh, "over_time_limit", why), &setting);
        }
        try {
            PosedDeformer& deformer = deformers_.emplace_back(setting, mesh, poses_, 1 + rounds_of_own_clock().fewest);
            ReachedPoint point{&setting, &mesh, deformer.reach(), {}};
            point.on_base = mesh.on_base(point.shape.positions);
            const bool is_fem = options_if<FemOptions>(setting.spec) != nullptr;
            const bool is_of_the_paper = options_if<pbs::PbsOptions>(setting.spec) || traits_of(setting.spec).blends_linearly;
            if (!point.shape.finished && (is_of_the_paper || setting.is_external()))
                measured_.breakdown += setting.deformer + (setting.change ? " " + setting.tuned : "") + " is not finite. ";
            if (!is_fem && 1e3 * point.shape.seconds > of_.longest_frame_ms) too_slow_[ladder] = 1e3 * point.shape.seconds;
            points_.push_back(std::move(point));
        } catch (const pbs::InputError& error) {
            if (setting.is_external()) throw;
            if (deformers_.size() > points_.size()) deformers_.pop_back();
            add_row_of_case(row_without_answer(setting, mesh, "not_applicable", error.what()), &setting);
        }
    }

    // A program computes its turns ahead, so that other deformers do not disturb them. take_turns adds one that warms up.
    Rounds rounds_of_own_clock() const { return {.seconds = 0.0, .fewest = of_.rounds.fewest, .most = of_.rounds.fewest}; }

    // The times of the rounds [ms] of those that reached the pose. The nonlinear laws take turns among themselves, and so do the others.
    std::vector<std::vector<double>> time_all()
    {
        std::vector<std::vector<double>> times(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (points_[i].shape.finished && deformers_[i].has_own_clock())
                times[i] = take_turns({[this, i] { return deformers_[i].turn(); }}, rounds_of_own_clock())[0][0];
        for (const bool newton : {false, true}) {
            std::vector<std::size_t> which;
            std::vector<TimedVariant> turns;
            for (std::size_t i = 0; i < points_.size(); ++i) {
                if (!points_[i].shape.finished || points_[i].setting->is_newton() != newton || deformers_[i].has_own_clock()) continue;
                which.push_back(i);
                turns.push_back([this, i] {
                    stop_if_interrupted();
                    return deformers_[i].turn();
                });
            }
            const auto samples = take_turns(turns, newton ? of_.newton_rounds : of_.rounds);
            for (std::size_t k = 0; k < which.size(); ++k) times[which[k]] = samples[k][0];
        }
        return times;
    }

    void add_row(const ReachedPoint& point, const PosedDeformer& deformer, const std::vector<double>& samples_ms)
    {
        PointRow row = point_row(point);
        add_time(row, samples_ms);
        if (!row.is_external) row.work = deformer.work();  // such a deformer counts nothing
        if (row.ms_median) row.clock = deformer.clock();
        if (point.shape.finished) references_->add_errors(row, point.on_base);
        const ReachedPoint* limit = limit_of_deformers();
        if (point.shape.finished && point.setting->on_own_mesh() && limit)
            row.to_linear_elements_pct = references_->first().distance(point.on_base, limit->on_base).joint_pct;
        add_reference(row, references_->first());
        if (of_.range.changes && row.error && (point.setting->change || is_baseline(row.key)))
            for (std::size_t b = 0; b < budget_iterations.size(); ++b)
                if (const ReachedPoint* of_pbs = baseline_after(budget_iterations[b]))
                    row.from_pbs_pct[b] = references_->first().distance(point.on_base, of_pbs->on_base).joint_pct;
        const pbs::Positions* shape = row.error ? &point.on_base : nullptr;
        add_row_of_case(std::move(row), point.setting, shape);
    }

    // The rows of changes have a table of their own, to which PBS belongs, too.
    void add_row_of_case(PointRow row, const Setting* setting = nullptr, const pbs::Positions* shape = nullptr)
    {
        row.of = of_.of;
        row.half = of_.half;
        const bool is_change = setting && setting->change;
        if (!is_change) measured_.rows.push_back(row), measured_.shapes.add(shape);
        if (!is_change && !(of_.range.changes && is_baseline(row.key))) return;
        references_->set_reference_of_change(row);
        measured_.changes.push_back(std::move(row));
    }

    static bool is_baseline(const SettingKey& key)
    {
        return key.deformer == baseline && key.packed && key.tuned.empty() && !key.wanted_vertices && !key.refined;
    }

    // Null where that takes too long.
    const ReachedPoint* baseline_after(int iterations) const
    {
        const auto found = std::ranges::find_if(points_, [&](const ReachedPoint& point) {
            const SettingKey key = key_of(*point.setting);
            return !point.setting->change && is_baseline(key) && key.iterations == iterations;
        });
        return found == points_.end() ? nullptr : &*found;
    }

    const WorkPrecisionCase& of_;
    std::string solutions_;
    std::shared_ptr<const pbs::Character> base_;
    PosePair poses_;
    std::vector<Setting> external_, compared_;  // the settings of the user's own deformers and those of the others
    std::optional<ReferenceSet> references_;    // none until the user's own deformers have reached the pose
    static constexpr int refined = -1, smooth_weights = -2;
    std::map<int, BodyMesh> meshes_;  // by wanted size; 0: the case's own
    std::deque<PosedDeformer> deformers_;
    std::vector<ReachedPoint> points_;       // of each of these deformers
    std::map<SettingKey, double> too_slow_;  // ladders, and the time of the setting that exceeded the limit [ms]
    MeasuredPoints measured_;
};

}  // namespace

void add_time(PointRow& row, std::vector<double> samples)
{
    constexpr int fewest_for_quartiles = 3;  // rounds
    row.failed_rounds = static_cast<int>(std::erase_if(samples, [](double ms) { return std::isnan(ms); }));
    if (samples.empty()) return;
    const Spread ms = spread_of(samples);
    row.rounds = ms.rounds;
    row.ms_median = ms.median;
    if (ms.rounds >= fewest_for_quartiles) row.ms_q1 = ms.lower, row.ms_q3 = ms.upper;
}

double neutral_length(double k, const std::vector<double>& edge_lengths_m)
{
    const double longest = std::ranges::max(edge_lengths_m);
    const auto mean_k = [&](double length_m) {
        double sum = 0.0;
        for (const double l : edge_lengths_m) sum += pbs::stiffness_at_length(k, l, length_m);
        return sum / double(edge_lengths_m.size());
    };
    double low = std::ranges::min(edge_lengths_m), high = longest;  // all are at most k, at least k
    while (high - low > 1e-12 * longest) {
        const double middle = std::midpoint(low, high);
        (mean_k(middle) < k ? low : high) = middle;
    }
    return high;
}

MeasuredPoints measure_points(const WorkPrecisionCase& of, const std::string& solutions)
{
    return CaseMeasuring(of, solutions).measure();
}

}  // namespace experiments
