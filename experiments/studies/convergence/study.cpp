// C03, C12: how fast the solver converges, from which initial guess, and towards what. Every run iterates the paper's
// constraints far past its 24 iterations from four initial guesses and measures residuals, volume and the error to the
// reference (shared/posed_reference.hpp). Two controls and the author's later code are iterated in the paper's order
// and precision. README.md describes the runs and records.
//
// The reference of a pose takes minutes, so that only the poses that `ensemble` has too are compared with it, and the
// ladder without solutions on finer tets, and therefore without a bound.
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/scene/movements.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <random>

namespace experiments {
namespace {

// The solver advanced from step to step, each step from the result of the last one.
class WarmStarted {
public:
    WarmStarted(const pbs::Character& character, const pbs::Motion& motion, const pbs::PbsOptions& options)
        : character_(character),
          motion_(motion),
          solver_(character.mesh, character.binding.distance, {}, options),
          positions_(blended(character, motion.steps.front()))
    {
    }

    const pbs::Positions& before(std::size_t step)
    {
        for (; next_ < step; ++next_) {
            solver_.advance(positions_, pbs::posed_bind_points(character_.binding, motion_.steps[next_]),
                            motion_.time_step_s);
            positions_ = solver_.positions();
        }
        return positions_;
    }

private:
    const pbs::Character& character_;
    const pbs::Motion& motion_;
    pbs::PbsSolver solver_;
    pbs::Positions positions_;
    std::size_t next_ = 0;
};

std::vector<int> frame_numbers(const std::vector<NamedFrame>& frames)
{
    std::vector<int> numbers;
    for (const NamedFrame& frame : frames) numbers.push_back(frame.frame);
    return numbers;
}

// Uniform in the box around a shape, the same on every machine [m], #V x 3.
pbs::Positions random_positions(const pbs::Positions& shape)
{
    const Eigen::RowVector3d low = shape.colwise().minCoeff(), size = shape.colwise().maxCoeff() - low;
    std::mt19937_64 engine(1);
    pbs::Positions positions(shape.rows(), 3);
    for (Eigen::Index vertex = 0; vertex < shape.rows(); ++vertex)
        for (int axis = 0; axis < 3; ++axis)
            positions(vertex, axis) = low(axis) + 0x1p-53 * double(engine() >> 11) * size(axis);
    return positions;
}

Scene at_size(Scene scene, int vertices)
{
    scene.character.vertices = vertices;
    return scene;
}

// One mesh of the body.
class Mesh {
public:
    Mesh(const ConvergenceCase& convergence_case, const Scene& scene, bool own, const std::string& solutions)
        : of_(convergence_case),
          solutions_(solutions),
          own_(own),
          settings_(own || scene.character.vertices <= convergence_case.every_setting_to
                        ? convergence_case.settings.size()
                        : 1),
          posed_(scene, frame_numbers(convergence_case.frames)),
          motion_(make_motion(scene.motion, posed_.character().skeleton, scene.file))
    {
        for (std::size_t frame = 0; frame < convergence_case.frames.size(); ++frame)
            references_.push_back(reference_in(frame));
    }

    void add_to(ConvergenceResult& result) const
    {
        for (std::size_t frame = 0; frame < references_.size(); ++frame)
            if (!references_[frame].why.empty())
                result.breakdown += fmt::format("{} in {}: not reached, {}. ", of_.reference.label,
                                                of_.frames[frame].name, references_[frame].why);
        for (const double k_stretch : of_.k_stretch) {
            pbs::PbsOptions options = options_of<pbs::PbsOptions>(spec_of(of_.scene, "pbs"));
            options.k_stretch = k_stretch;
            const std::vector<FrameStarts> starts =
                starts_of(posed_.character(), motion_, frame_numbers(of_.frames), options);
            for (std::size_t setting = 0; setting < settings_; ++setting)
                for (std::size_t frame = 0; frame < starts.size(); ++frame)
                    add(follow(starts[frame], frame, of_.settings[setting], options), result);
        }
    }

private:
    struct FrameReference {
        std::string name;      // or why there is none
        std::string why = {};  // if it was not reached: its worst tet
        std::optional<PosedReference> solved = {};
    };

    FrameReference reference_in(std::size_t frame) const
    {
        const pbs::Character& character = posed_.character();
        if (!of_.frames[frame].compared) return {"none"};
        if (!own_ && !of_.ladder) return {"own_mesh_alone"};
        if (character.mesh.rest.rows() > of_.reference_to)
            return {fmt::format("left_out_above_{}_vertices", of_.reference_to)};
        const ReferenceEffort effort = of_.ladder ? ReferenceEffort::own_tets : of_.effort;
        PosedReference reference(character, of_.reference, posed_.pose(frame), of_.scene.motion.time_step_s, effort,
                                 solutions_);
        if (!reference.is_reached())
            return {.name = of_.reference.label + "_was_not_reached", .why = reference.why_not_reached()};
        return {.name = of_.reference.label, .solved = std::move(reference)};
    }

    static ReferenceQuality quality_of(const PosedReference& reference)
    {
        ReferenceQuality quality{.masked_share_pct = reference.masked_share_pct()};
        if (const double bound_pct = reference.bound().joint_pct; std::isfinite(bound_pct))
            quality.bound_pct = bound_pct;
        return quality;
    }

    static void add(ConvergencePaths paths, ConvergenceResult& result)
    {
        for (std::size_t start = 0; start < paths.paths.size(); ++start)
            if (!paths.paths[start].finite)
                result.breakdown +=
                    fmt::format("{} from {} is not finite. ", paths.of.pose, name_of(static_cast<SolverStart>(start)));
        result.all.push_back(std::move(paths));
    }

    ConvergencePaths follow(const FrameStarts& starts, std::size_t frame, const ProjectionSetting& setting,
                            pbs::PbsOptions options) const
    {
        options.order = setting.order;
        options.precision = setting.precision;
        const pbs::Character& character = posed_.character();
        const FrameReference& reference = references_[frame];
        const IterationMetrics iteration_metrics(character, starts.bind_points,
                                                 reference.solved ? &*reference.solved : nullptr);
        ConvergencePaths paths{.of = {of_.scene.character.body, of_.frames[frame].name, int(character.mesh.rest.rows()),
                                      int(character.mesh.tets.rows()), own_, name_of(options.order),
                                      name_of(options.precision), options.k_stretch},
                               .key = of_.frames[frame].key,
                               .character = !of_.scene.motion.clip.empty() || !of_.scene.motion.movements.empty(),
                               .twist = of_.frames[frame].twist,
                               .reference = reference.name};
        if (reference.solved) paths.quality = quality_of(*reference.solved);
        const auto iterated = [&](const std::vector<pbs::Positions>& guesses, const IterationMetrics& metrics) {
            return iterate(character, options, starts.bind_points, guesses, of_.most_iterations, metrics);
        };
        const auto& shapes = starts.shapes;
        paths.paths =
            iterated({shapes.begin(), of_.from_lbs_alone ? shapes.begin() + 1 : shapes.end()}, iteration_metrics);
        const bool is_papers = setting.order == pbs::Order::plain && setting.precision == pbs::Precision::f64;
        if (is_papers && !paths.twist && !of_.ladder) {
            const IterationMetrics without_reference(character, starts.bind_points);
            paths.controls = iterated({shapes.front(), starts.random}, without_reference);
            if (paths.character)
                paths.author = author_path(character, posed_.pose(frame), of_.most_iterations, without_reference);
        }
        return paths;
    }

    const ConvergenceCase& of_;
    std::string solutions_;
    bool own_;
    std::size_t settings_;  // the number of the case's settings that are run
    PosedCharacter posed_;
    pbs::Motion motion_;
    std::vector<FrameReference> references_;  // one per frame
};

std::string measure_and_record(const ConvergenceCase& convergence_case, const std::string& folder)
{
    const ConvergenceResult result = measure_convergence(convergence_case, solutions_of_run(folder));
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    const std::vector<LookRow> looks = look_rows(result);
    table_of(residual_columns, looks).write(path("residuals.csv"));
    table_of(towards_columns, towards_rows(looks)).write(path("towards.csv"));
    std::vector<RateRow> rows = rate_rows(result);
    std::vector<analysis::Measurement> measured = convergence_values(rows, convergence_case.ladder);
    if (convergence_case.exponents) std::ranges::move(convergence_conclusions(measured), std::back_inserter(measured));
    analysis::measurement_table(measured).write(path("measurements.csv"));
    std::erase_if(rows, [](const RateRow& row) { return row.kind != PathKind::guess; });
    table_of(rate_columns, rows).write(path("rates.csv"));
    return result.breakdown;
}

// frames = [{ pose = "crouch", frame = 164, compared = true }, ...], or with angle_deg or time_s. The frame is named
// after these.
NamedFrame frame_of(const std::string& motion, const nlohmann::json& values)
{
    NamedFrame frame{
        .frame = values.at("frame"), .name = motion, .key = {.motion = motion}, .twist = motion == "twist"};
    frame.compared = values.value("compared", false);
    if (values.contains("angle_deg"))
        frame.name += fmt::format("_{:g}", frame.key.angle_deg.emplace(values.at("angle_deg")));
    if (values.contains("time_s"))
        frame.name += fmt::format("_at_{:g}_s", frame.key.time_s.emplace(values.at("time_s")));
    if (values.contains("pose")) frame.name += "_" + (frame.key.pose = values.at("pose"));
    return frame;
}

// The ends of the ranges of these movements.
std::vector<NamedFrame> ends_of(const std::vector<std::string>& movements, int frames)
{
    std::vector<NamedFrame> ends;
    for (const std::string& name : movements)
        ends.push_back({static_cast<int>(ends.size() + 1) * frames,
                        name,
                        {.motion = "range_of_motion", .pose = name},
                        is_twist(name)});
    return ends;
}

// orders and precisions = ["ordered f32", "plain f64"].
ProjectionSetting setting_of(const std::string& text)
{
    const std::size_t blank = text.find(' ');
    return {option_of<pbs::Order>(text.substr(0, blank)), option_of<pbs::Precision>(text.substr(blank + 1))};
}

void add_case(const StudyCase& study_case, StudyPlan& plan)
{
    ConvergenceCase convergence_case{.scene = study_case.scene()};
    if (study_case.value("through_movements", false)) {
        const auto movements = movements_of(pbs::make_character(convergence_case.scene.character).skeleton);
        convergence_case.scene =
            study_case.scene({fmt::format("motion.movements=['{}']", fmt::join(movements, "','"))});
        convergence_case.frames = ends_of(movements, convergence_case.scene.motion.frames);
    } else {
        const auto motion = study_case.value<std::string>("motion");
        for (const nlohmann::json& frame : study_case.value<nlohmann::json>("frames"))
            convergence_case.frames.push_back(frame_of(motion, frame));
    }
    const auto& options = options_of<pbs::PbsOptions>(spec_of(convergence_case.scene, "pbs"));
    convergence_case.k_stretch = study_case.value("k_stretch", std::vector<double>{options.k_stretch});
    for (const auto& setting : study_case.value<std::vector<std::string>>("settings"))
        convergence_case.settings.push_back(setting_of(setting));
    convergence_case.other_vertices = study_case.value<std::vector<int>>("other_vertices", {});
    convergence_case.every_setting_to = study_case.value("every_setting_to", 0);
    convergence_case.ladder = study_case.value("ladder", false);
    convergence_case.exponents = convergence_case.ladder && study_case.value("exponents", true);
    convergence_case.from_lbs_alone = study_case.value("from_lbs_alone", false);
    convergence_case.reference = reference_flesh(convergence_case.scene);
    convergence_case.reference_to = study_case.value("reference_to", convergence_case.reference_to);
    plan.runs.push_back(work_run(study_case.name, convergence_case, study_case.cost_s, measure_and_record));
}

StudyPlan plan(bool full)
{
    return plan_of_cases("convergence", full, add_case);
}

}  // namespace

const char* name_of(SolverStart start)
{
    static constexpr const char* names[] = {"lbs", "previous_frame", "rest_pose", "rigid_bind"};
    return names[static_cast<int>(start)];
}

std::vector<FrameStarts> starts_of(const pbs::Character& character, const pbs::Motion& motion,
                                   const std::vector<int>& frames, const pbs::PbsOptions& options)
{
    const pbs::Character rigid = pbs::with_weights(pbs::WeightKind::rigid, character);
    WarmStarted warm(character, motion, options);
    std::vector<FrameStarts> starts;
    for (const int frame : frames) {
        const std::size_t step = static_cast<std::size_t>(frame) * motion.steps_per_frame;
        const pbs::Pose& pose = motion.steps.at(step);
        const pbs::Positions lbs = blended(character, pose);
        starts.push_back({bind_points_of(options, character, pose, lbs),
                          {lbs, warm.before(step), character.mesh.rest, blended(rigid, pose)},
                          random_positions(lbs)});
    }
    return starts;
}

IterationPath author_path(const pbs::Character& character, const pbs::Pose& pose, int most,
                          const IterationMetrics& iteration_metrics)
{
    pbs::AuthorSolver solver(character.mesh, character.skeleton, character.binding, {});
    const std::vector<pbs::BoneSegment> bones = solver.posed_bones(pose);
    pbs::Positions lbs;
    pbs::linear_blend_skinning(character.mesh.rest, pbs::author_weights(character.binding, character.skeleton), pose,
                               lbs);
    StepLoops loops;
    loops.load = [&] { solver.predict(pose); };
    loops.bind = [&] { solver.project(bones); };  // all classes
    loops.stretch = loops.volume = [] {};
    loops.store = [&]() -> const pbs::Positions& {
        solver.update();
        return solver.positions();
    };
    return follow(loops, lbs, most, iteration_metrics);
}

RECORD_SETTINGS(NamedFrame, frame, name, key, twist, compared)
RECORD_SETTINGS(ProjectionSetting, order, precision)
RECORD_SETTINGS_AND(ConvergenceCase,
                    .derived("looks",
                             [](const ConvergenceCase& convergence_case) -> nlohmann::json {
                                 return looked_at(convergence_case.most_iterations);
                             })
                        .constant("residual_tolerance", residual_tolerance)
                        .constant("satisfied_residual", satisfied_residual)
                        .constant("volume_tolerance_pct", analysis::kept_volume_pct),
                    scene, frames, k_stretch, settings, other_vertices, every_setting_to, ladder, exponents,
                    from_lbs_alone, most_iterations, reference, effort, reference_to)

ConvergenceResult measure_convergence(const ConvergenceCase& convergence_case, const std::string& solutions)
{
    ConvergenceResult result;
    result.ladder = convergence_case.ladder;
    Mesh(convergence_case, convergence_case.scene, true, solutions).add_to(result);
    for (const int vertices : convergence_case.other_vertices)
        Mesh(convergence_case, at_size(convergence_case.scene, vertices), false, solutions).add_to(result);
    return result;
}

Study convergence_study()
{
    return {"convergence", plan, quick_and_full, nullptr, false, nullptr, add_case, convergence_conclusions};
}

}  // namespace experiments
