// C03, C12: how fast the solver converges, from which initial guess, and towards what. Every run iterates the paper's constraints far past
// its 24 iterations from four initial guesses (convergence/convergence_case.hpp) and measures residuals, volume and the error to the
// reference (shared/posed_reference.hpp).
//
//   limb_twist, limb_bend   90 and 170 deg, 60 and 90 deg; three orders, two precisions, other tessellations of the same size
//   human, ...              poses of the clip 01_01, every real body that is installed, at the sizes of Table 1
//   ladder_twist, _bend     the limb from 500 vertices to 4,000 in three orders (--full: to 100,000 in one), with the reference up to
//                           2,500 vertices. rates.csv states which meshes have no reference
//
// The reference of a pose takes minutes, so the quick form has it only at twist 90, bend 60, in the human's crouch and on the ladder. It
// has no solution on finer tets there, and therefore no bound.
//
// Writes DIR/convergence/RUN/residuals.csv, rates.csv, towards.csv, measurements.csv.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace experiments {
namespace {

std::string measure_and_record(const ConvergenceCase& of, const std::string& folder)
{
    const ConvergenceResult result = measure_convergence(of);
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    const std::vector<LookRow> looks = look_rows(result);
    table_of(residual_columns, looks).write(path("residuals.csv"));
    table_of(rate_columns, rate_rows(result)).write(path("rates.csv"));
    table_of(towards_columns, towards_rows(looks)).write(path("towards.csv"));
    analysis::measurement_table(convergence_values(result)).write(path("measurements.csv"));
    return result.breakdown;
}

// frames = [{ pose = "crouch", frame = 164, compared = true }, ...], or with angle_deg or time_s. The frame is named after these.
NamedFrame frame_of(const std::string& motion, const nlohmann::json& values)
{
    NamedFrame frame{.frame = values.at("frame"), .name = motion, .key = {.motion = motion}, .twist = motion == "twist"};
    frame.compared = values.value("compared", false);
    if (values.contains("angle_deg")) frame.name += fmt::format("_{:g}", frame.key.angle_deg.emplace(values.at("angle_deg")));
    if (values.contains("time_s")) frame.name += fmt::format("_at_{:g}_s", frame.key.time_s.emplace(values.at("time_s")));
    if (values.contains("pose")) frame.name += "_" + (frame.key.pose = values.at("pose"));
    return frame;
}

// orders and precisions = ["ordered f32", "plain f64"].
ProjectionSetting setting_of(const std::string& text)
{
    const std::size_t blank = text.find(' ');
    return {option_of<pbs::Order>(text.substr(0, blank)), option_of<pbs::Precision>(text.substr(blank + 1))};
}

StudyPlan plan(bool full)
{
    return plan_of_cases("convergence", full, [full](const StudyCase& in_file, StudyPlan& plan) {
        ConvergenceCase of{.scene = in_file.scene()};
        const auto motion = in_file.value<std::string>("motion");
        for (const nlohmann::json& frame : in_file.value<nlohmann::json>("frames")) of.frames.push_back(frame_of(motion, frame));
        of.k_stretch = in_file.value<std::vector<double>>("k_stretch");
        for (const auto& setting : in_file.value<std::vector<std::string>>("settings")) of.settings.push_back(setting_of(setting));
        of.other_vertices = in_file.value<std::vector<int>>("other_vertices", {});
        of.every_setting_to = in_file.value("every_setting_to", 0);
        of.ladder = in_file.value("ladder", false);
        of.reference = reference_flesh(of.scene);
        of.refines_reference = full;
        of.reference_to = in_file.value("reference_to", of.reference_to);
        plan.runs.push_back(work_run(in_file.name, of, in_file.cost_s, measure_and_record));
    });
}

// One row per pose and initial guess, in the default order; of a ladder the LBS guess on each mesh.
StudyConclusion conclude(const FinishedRuns& finished)
{
    std::vector<RateRow> shown;
    for (const std::string& file : finished.files("rates.csv")) {
        const bool is_ladder = std::filesystem::path(file).parent_path().filename().string().starts_with("ladder");
        for (const RateRow& row : rows_of(rate_columns, analysis::read_csv(file))) {
            const bool is_shown = is_ladder ? row.of.start == name_of(SolverStart::lbs) : row.of.own_mesh;
            if (is_shown && row.of.order == "ordered" && row.of.precision == "f32") shown.push_back(row);
        }
    }
    return {text_table(table_of(rate_columns, shown),
                       analysis::report_columns("body pose vertices k_stretch start rate_per_iteration:.4f iterations_to_residual "
                                                "residual_reached iterations_to_volume volume_reached masked_share_pct:.1f "
                                                "reference_bound_pct:.2f error_24_pct:.1f least_error_iteration last_error_pct:.1f")),
            !finished.none()};
}

// C03, C12: the paths in one pose, on the scene's mesh and in its order. C12 is judged on characters alone. The first reading's k_stretch
// names the case of all of them.
std::vector<ReadingValues> read_paths(const StudyCase& of, const std::vector<Overrides>& readings)
{
    std::vector<ReadingValues> all;
    std::optional<double> k_stretch;
    for (const Overrides& reading : readings) {
        ConvergenceCase read;
        read.scene = of.scene(reading);
        read.frames = {{of.value<int>("frame"), of.name, of.key()}};
        read.most_iterations = of.value<int>("iterations");
        const auto& options = options_of<pbs::PbsOptions>(spec_of(read.scene, "pbs"));
        read.k_stretch = {options.k_stretch};
        read.settings = {{options.order, options.precision}};
        ConvergenceResult result = measure_convergence(read);
        if (!k_stretch) k_stretch = options.k_stretch;
        result.all.front().of.k_stretch = *k_stretch;
        all.push_back({convergence_values(result), !result.breakdown.empty()});
        if (!result.all.front().character) all.back().left_out = all_but("C12", {}, "judged on characters alone");
    }
    return all;
}

}  // namespace

Study convergence_study()
{
    return {"convergence", plan, quick_and_full, conclude, false, nullptr, read_paths};
}

}  // namespace experiments
