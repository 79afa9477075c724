#include "experiments/studies/fit/poisson_run.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/fit/poisson_fit.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/pose.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {

using analysis::Columns;

namespace {

const Columns<PoissonSetting> elastic_columns = {{"model", &PoissonSetting::model, "", "constitutive model of the elastic body"},
                                                 {"element_order", &PoissonSetting::element_order, "", "polynomial order of its elements"},
                                                 {"formulation", &PoissonSetting::formulation, "", "how volume enters them"},
                                                 {"attachment", &PoissonSetting::attachment, "", "how the bones hold it"},
                                                 {"body", &PoissonSetting::body, "", "the body that is fitted: pbs, or pbs_converged"},
                                                 {"k_stretch", &PoissonSetting::k_stretch, "", "its stiffness"},
                                                 {"iterations", &PoissonSetting::iterations, "", "its iterations, the most of any pose"}};

}  // namespace

const Columns<PoissonRow> poisson_columns =
    within(&PoissonRow::setting, elastic_columns) +
    Columns<PoissonRow>{{"converged_poses", &PoissonRow::converged_poses, "", "poses in which pbs_converged did converge"},
                        {"poses", &PoissonRow::poses, "", "poses that the ratio is fitted to"},
                        {"poisson", &PoissonRow::poisson, "", "Poisson's ratio"},
                        {"poisson_low", &PoissonRow::low, "", "lower end of its interval"},
                        {"poisson_high", &PoissonRow::high, "", "upper end of its interval"}} +
    within(&PoissonRow::quality, quality_columns()) +
    Columns<PoissonRow>{{"misfit_at_0_pct", &PoissonRow::misfit_at_0_pct, "%", "misfit at the ratio 0"},
                        {"misfit_at_highest_pct", &PoissonRow::misfit_at_highest_pct, "%", "misfit at the highest ratio"},
                        {"highest_poisson", &PoissonRow::highest_poisson, "", "highest ratio at which all poses converged"}};

const Columns<PoissonPoseRow> poisson_pose_columns =
    within(&PoissonPoseRow::setting, elastic_columns) +
    Columns<PoissonPoseRow>{{"pose", &PoissonPoseRow::pose, "", "name of the pose"},
                            {"poisson", &PoissonPoseRow::poisson, "", "Poisson's ratio by this pose alone"}} +
    within(&PoissonPoseRow::quality, quality_columns());

const Columns<ValleyRow> valley_columns =
    within(&ValleyRow::setting, elastic_columns) +
    Columns<ValleyRow>{{"poisson", &ValleyRow::poisson, "", "Poisson's ratio of the finite elements"},
                       {"misfit_pct", &ValleyRow::misfit_pct, "%", "misfit of all poses at this ratio"}};

namespace {

constexpr int chunk = 100;        // iterations between two looks at the positions
constexpr double still = 1e-6;    // of the bounding diagonal: converged where no vertex moves by more in such a chunk
constexpr double sweep_s = 0.01;  // time step of the poses, which nothing depends on
using Paths = std::vector<std::vector<NamedPose>>;

FemOptions options_of(const ElasticBody& body)
{
    FemOptions options;
    options.model = body.model;
    options.element_order = body.element_order;
    if (body.element_order == 2) options.formulation = reference_fem::Formulation::mean_dilatation;
    return options;
}

std::vector<NamedPose> sweep_poses(const pbs::Skeleton& skeleton, const std::string& name, const pbs::Vec3& axis,
                                   const std::vector<double>& angles_deg)
{
    std::vector<NamedPose> poses;
    for (const double angle_deg : angles_deg)
        poses.push_back({fmt::format("{}_{:g}", name, angle_deg),
                         pbs::joint_sweep(skeleton, pbs::find_bone(skeleton, "forearm"), axis, angle_deg, 2, sweep_s).steps.back()});
    return poses;
}

// PBS in all poses, after the paper's iterations or until nothing moves any more. The remaining error is that of the model.
struct PosedPbs {
    double k_stretch = 0.0;
    bool until_converged = false;
    int iterations = 0, converged_poses = 0;
    std::vector<pbs::Positions> positions = {};  // one per pose [m], #V x 3
};

// Nothing jiggles, so a step that begins where the last one ended continues its iterations.
void iterate_in_pose(const pbs::Character& character, const pbs::Pose& pose, pbs::PbsOptions options, int most_iterations, PosedPbs& posed)
{
    if (posed.until_converged) options.iterations = chunk;
    pbs::PbsSolver solver(character.mesh, character.binding.distance, {}, options);
    const pbs::Positions bind_points = pbs::posed_bind_points(character.binding, pose);
    const double diagonal_m = (character.mesh.rest.colwise().maxCoeff() - character.mesh.rest.colwise().minCoeff()).norm();
    pbs::Positions positions;
    pbs::linear_blend_skinning(character.mesh.rest, character.weights, pose, positions);
    bool converged = false;
    int iterations = 0;
    do {
        stop_if_interrupted();
        solver.advance(positions, bind_points, 1.0);
        iterations += options.iterations;
        converged = (solver.positions() - positions).rowwise().norm().maxCoeff() <= still * diagonal_m;
        positions = solver.positions();
    } while (posed.until_converged && iterations < most_iterations && !converged);
    posed.iterations = std::max(posed.iterations, iterations);
    posed.converged_poses += posed.until_converged && converged;
    posed.positions.push_back(std::move(positions));
}

PosedPbs posed_pbs(const pbs::Character& character, const Paths& paths, double k_stretch, bool until_converged, int most_iterations)
{
    pbs::PbsOptions options;
    options.k_stretch = k_stretch;
    options.precision = pbs::Precision::f64;
    PosedPbs posed{.k_stretch = k_stretch, .until_converged = until_converged};
    for (const auto& path : paths)
        for (const NamedPose& pose : path) iterate_in_pose(character, pose.pose, options, most_iterations, posed);
    return posed;
}

struct PoissonRows {
    std::vector<PoissonRow> fits;
    std::vector<PoissonPoseRow> poses;
    std::vector<ValleyRow> valleys;
};

void add_fit(PoissonRows& rows, const FemOptions& elastic, const PosedPbs& body, const PoissonFit& fit)
{
    const PoissonSetting setting = {.model = name_of(elastic.model),
                                    .element_order = elastic.element_order,
                                    .formulation = name_of(elastic.formulation),
                                    .attachment = name_of(elastic.attachment),
                                    .body = body.until_converged ? "pbs_converged" : "pbs",
                                    .k_stretch = body.k_stretch,
                                    .iterations = body.iterations};
    const analysis::Interval& poisson = fit.poisson.interval;
    rows.fits.push_back({setting, body.converged_poses, static_cast<int>(fit.poses.size()), poisson.estimate, poisson.low, poisson.high,
                         quality_of(fit.poisson.all), fit.valley.front().value, fit.valley.back().value, fit.highest_poisson});
    for (std::size_t p = 0; p < fit.poses.size(); ++p)
        rows.poses.push_back({setting, fit.poses[p], fit.poisson.cases[p].x, quality_of(fit.poisson.cases[p])});
    for (const auto& point : fit.valley) rows.valleys.push_back({setting, point.parameter, point.value});
}

// Lists the poses that did not converge, and the interpolation error of the others.
nlohmann::json to_json(const ElasticPoses& elastic)
{
    nlohmann::json json = nlohmann::json::array();
    for (const auto& pose : elastic.poses())
        json.push_back({{"pose", pose.pose.name},
                        {"converged", pose.family.has_value()},
                        {"highest_poisson", pose.highest_poisson},
                        {"interpolation_error_pct", pose.interpolation_error_pct}});
    return json;
}

}  // namespace

nlohmann::json to_json(const ElasticBody& body)
{
    static const auto fields = OptionFields<ElasticBody>("elastic")
                                   .record("model", &ElasticBody::model)
                                   .record("element_order", &ElasticBody::element_order)
                                   .derived("formulation", [](const ElasticBody& of) { return name_of(options_of(of).formulation); })
                                   .derived("attachment", [](const ElasticBody& of) { return name_of(options_of(of).attachment); })
                                   .complete();
    return fields.json(body);
}

nlohmann::json to_json(const PoissonCase& of)
{
    static const auto fields = OptionFields<PoissonCase>("poisson")
                                   .record("elastic", &PoissonCase::elastic)
                                   .record("vertices", &PoissonCase::vertices)
                                   .record("ratios", &PoissonCase::ratios)
                                   .record("most_iterations", &PoissonCase::most_iterations)
                                   .record("angles_deg", &PoissonCase::angles_deg)
                                   .record("k_stretch", &PoissonCase::k_stretch)
                                   .complete();
    return fields.json(of);
}

std::string record_poisson(const PoissonCase& of, const std::string& folder)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = of.vertices});
    const Paths paths = {sweep_poses(limb.skeleton, "twist", pbs::Vec3::UnitX(), of.angles_deg),
                         sweep_poses(limb.skeleton, "bend", pbs::Vec3::UnitZ(), of.angles_deg)};
    std::vector<PosedPbs> bodies;
    for (const double k_stretch : of.k_stretch)
        for (const bool until_converged : {false, true})
            bodies.push_back(posed_pbs(limb, paths, k_stretch, until_converged, of.most_iterations));

    PoissonRows rows;
    nlohmann::json elastic_json;
    for (const ElasticBody& elastic_body : of.elastic) {
        const FemOptions options = options_of(elastic_body);
        const ElasticPoses elastic(limb, paths, options, of.ratios);
        elastic_json[fmt::format("{} P{} {}", name_of(options.model), options.element_order, name_of(options.attachment))] =
            to_json(elastic);
        for (const PosedPbs& body : bodies)
            if (const auto fit = fit_poisson(limb, elastic, body.positions)) add_fit(rows, options, body, *fit);
    }
    table_of(poisson_columns, rows.fits).write(analysis::path_in(folder, "poisson.csv"));
    table_of(poisson_pose_columns, rows.poses).write(analysis::path_in(folder, "poisson_poses.csv"));
    table_of(valley_columns, rows.valleys).write(analysis::path_in(folder, "valley.csv"));
    analysis::write_text_atomically(analysis::path_in(folder, "elastic.json"), elastic_json.dump(2) + "\n");
    return "";
}

}  // namespace experiments
