// The fit: which elastic body the paper's constraints are, so that k has a unit and comparisons are fair.
//
//   sag_N      ###=========      A bar of N vertices that is held at one end settles under gravity: Young's modulus against k_stretch,
//              ###      \  g     k_volume and iterations. The modulus scales with density / (time step)^2, exactly.
//   swing_N    ###=========~~    The same bar is let go: Young's modulus again, by the first frequency, in time.
//   poisson_*  o====o~~~~o       The limb is twisted and bent by 30, 60, 90 deg: Poisson's ratio of the finite elements nearest to the
//                                constraints, after 24 iterations and converged. Young's modulus cancels.
//
// Writes DIR/fit/{sag,swing,poisson,poisson_poses,valley}.csv, fit.json and fit.md.
#include "analysis/records/json_rows.hpp"
#include "analysis/records/report_table.hpp"
#include "analysis/statistics/fits.hpp"
#include "experiments/studies/fit/poisson_run.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace experiments {
namespace {

StudyPlan plan(bool full)
{
    StudyPlan plan;
    for (const int vertices : full ? std::vector<int>{300, 1000, 3000} : std::vector<int>{300, 1000})
        plan.runs.push_back(work_run<SagCase>(fmt::format("sag_{}", vertices), {vertices}, vertices / 20.0, record_sags));
    for (const int vertices : full ? std::vector<int>{300, 1000} : std::vector<int>{300})
        plan.runs.push_back(work_run<SwingCase>(fmt::format("swing_{}", vertices), {vertices}, vertices / 5.0, record_swings));

    using reference_fem::Model;
    PoissonCase large{.elastic = {{Model::neo_hookean, 1}, {Model::neo_hookean, 2}}, .angles_deg = {30.0, 60.0, 90.0}};
    if (full) large.vertices = 1775, large.ratios = 9, large.most_iterations = 40000;
    PoissonCase small = large;
    small.elastic = {{Model::linear, 2}};
    small.angles_deg = {5.0};
    plan.runs.push_back(work_run("poisson_large", large, full ? 1200.0 : 120.0, record_poisson));
    plan.runs.push_back(work_run("poisson_small", small, full ? 150.0 : 15.0, record_poisson));
    return plan;
}

int finest(const std::vector<SagRow>& rows)
{
    int vertices = 0;
    for (const SagRow& row : rows) vertices = std::max(vertices, row.setting.vertices);
    return vertices;
}

// The exponent with which Young's modulus grows over x, from rows that are alike in all else; null for fewer than two settled ones.
nlohmann::json exponent(const std::vector<SagRow>& rows, const std::function<double(const BarSetting&)>& x)
{
    std::vector<double> xs, young;
    for (const SagRow& row : rows)
        if (row.settled) xs.push_back(x(row.setting)), young.push_back(row.young_pa);
    if (xs.size() < 2) return nullptr;
    return analysis::observed_order(xs, young).slope.estimate;
}

// The exponents with which Young's modulus grows, for each k_stretch: the iterations on the finest mesh, the mean edge at 24 iterations.
nlohmann::json exponents(const std::vector<SagRow>& rows)
{
    nlohmann::json json = nlohmann::json::array();
    std::set<std::pair<double, double>> stiffnesses;
    for (const SagRow& row : rows) stiffnesses.insert({row.setting.k_volume, row.setting.k_stretch});
    for (const auto& [k_volume, k_stretch] : stiffnesses) {
        std::vector<SagRow> over_iterations, over_edge;
        for (const SagRow& row : rows) {
            if (row.setting.k_volume != k_volume || row.setting.k_stretch != k_stretch) continue;
            if (row.setting.vertices == finest(rows)) over_iterations.push_back(row);
            if (row.setting.iterations == 24) over_edge.push_back(row);
        }
        json.push_back({{"k_volume", k_volume},
                        {"k_stretch", k_stretch},
                        {"of_iterations", exponent(over_iterations, &BarSetting::iterations)},
                        {"of_mean_edge", exponent(over_edge, &BarSetting::mean_edge_m)},
                        {"of_time_step", -2.0}});
    }
    return json;
}

// Sag with volume constraints over sag without: 5/6 where they do what incompressibility does to a body of the same shear modulus whose
// central forces make nu = 1/4 (E = 2.5 mu against 3 mu); less is locking.
nlohmann::json volume_locking(const std::vector<SagRow>& rows)
{
    const auto is_pair = [](const SagRow& with, const SagRow& without) {
        const BarSetting &a = with.setting, &b = without.setting;
        return a.k_volume == 1.0 && b.k_volume == 0.0 && with.settled && without.settled && a.vertices == b.vertices &&
               a.k_stretch == b.k_stretch && a.iterations == b.iterations;
    };
    nlohmann::json json = nlohmann::json::array();
    for (const SagRow& with : rows)
        for (const SagRow& without : rows)
            if (is_pair(with, without))
                json.push_back({{"vertices", double(with.setting.vertices)},
                                {"k_stretch", with.setting.k_stretch},
                                {"iterations", double(with.setting.iterations)},
                                {"sag_over_sag_without_volume", without.young_pa / with.young_pa},
                                {"unlocked", 5.0 / 6.0}});
    return json;
}

std::string young_markdown(std::vector<SagRow> rows)
{
    std::erase_if(rows, [](const SagRow& row) { return row.setting.k_volume != 1.0; });
    return "## What k_stretch is worth\n\nYoung's modulus of the linear elastic bar (P2, nu 0.45, the same tets, the same vertices held) "
           "that sags as PBS does: k_volume 1, masses lumped, density 1000 kg/m^3, time step 10 ms. Every value scales with density / "
           "(time step)^2 exactly. The interval leaves out one fifth of the bar at a time; the misfit is what no modulus removes. Where a "
           "row is not settled (0), no state of rest was found, and its values have no meaning.\n\n" +
           markdown_table(table_of(sag_columns, rows),
                          {{"vertices", "vertices"},
                           {"mean edge [mm]", "mean_edge_m", "{:.1f}", 1e3},
                           {"k_stretch", "k_stretch"},
                           {"iterations", "iterations"},
                           {"E [kPa]", "young_pa", "{:.4g}", 1e-3},
                           {"E, low [kPa]", "young_low_pa", "{:.4g}", 1e-3},
                           {"E, high [kPa]", "young_high_pa", "{:.4g}", 1e-3},
                           {"misfit [%]", "misfit_pct", "{:.2g}"},
                           {"E dt^2 / (density edge^2 iterations)", "young_dt2_over_density_edge2_iterations", "{:.3g}"},
                           {"settled", "settled"},
                           {"identifiable", "identifiable"}});
}

std::string swing_markdown(const std::vector<SwingRow>& rows)
{
    return "\n## The same by the first frequency\n\nThe bar is let go from its sag at 0.1 % of its length, and zero crossings of the tip "
           "are measured. *expected* is what the recurrence of Algorithm 1 makes of the sag's modulus at that time step. Where the "
           "outcome is another than finished, there is no frequency.\n\n" +
           markdown_table(table_of(swing_columns, rows), {{"vertices", "vertices"},
                                                          {"k_stretch", "k_stretch"},
                                                          {"iterations", "iterations"},
                                                          {"time step [ms]", "time_step_s", "{:g}", 1e3},
                                                          {"outcome", "outcome"},
                                                          {"frequency [Hz]", "frequency_hz", "{:.4g}"},
                                                          {"damping ratio", "damping_ratio", "{:.3g}"},
                                                          {"E [kPa]", "young_pa", "{:.4g}", 1e-3},
                                                          {"E by sag [kPa]", "young_sag_pa", "{:.4g}", 1e-3},
                                                          {"ratio", "young_over_sag", "{:.4f}"},
                                                          {"expected", "expected_over_sag", "{:.4f}"}});
}

std::string poisson_markdown(const std::vector<PoissonRow>& fits)
{
    return "\n## Poisson's ratio\n\nThe nu of the finite elements nearest to PBS over all poses (error_joint, root mean square). The "
           "interval leaves out one pose at a time. Young's modulus cancels. The misfit is what no nu removes; *rise* is the share by "
           "which it rises when nu changes by 10 %. Where a fit is not identifiable (0), its nu has no meaning.\n\n" +
           markdown_table(table_of(poisson_columns, fits), {{"elements", "model"},
                                                            {"order", "element_order"},
                                                            {"formulation", "formulation"},
                                                            {"attachment", "attachment"},
                                                            {"body", "body"},
                                                            {"iterations", "iterations"},
                                                            {"k_stretch", "k_stretch"},
                                                            {"nu", "poisson", "{:.3f}"},
                                                            {"nu, low", "poisson_low", "{:.3f}"},
                                                            {"nu, high", "poisson_high", "{:.3f}"},
                                                            {"misfit [%]", "misfit_pct", "{:.3g}"},
                                                            {"misfit at nu 0", "misfit_at_0_pct", "{:.3g}"},
                                                            {"misfit at the highest nu", "misfit_at_highest_pct", "{:.3g}"},
                                                            {"highest nu that converged", "highest_poisson", "{:.4g}"},
                                                            {"outcome", "outcome"},
                                                            {"rise", "rise", "{:.2g}"},
                                                            {"identifiable", "identifiable"}});
}

std::string summary(std::vector<SagRow> sags, const std::vector<PoissonRow>& fits)
{
    std::erase_if(sags, [](const SagRow& row) { return row.setting.k_volume != 1.0 || row.setting.iterations != 24 || !row.settled; });
    const auto identifiable = std::ranges::count_if(fits, [](const PoissonRow& row) { return row.quality.identifiable; });
    return "fit: Young's modulus of a bar, k_volume 1, 24 iterations, time step 10 ms, density 1000 kg/m^3\n" +
           text_table(table_of(sag_columns, sags),
                      {{"vertices", "vertices"}, {"k_stretch", "k_stretch"}, {"E [kPa]", "young_pa", "{:.4g}", 1e-3}}) +
           fmt::format("fit: Poisson's ratio is identifiable in {} of {} fits; see fit.md\n", identifiable, fits.size());
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    const auto sags = finished.rows(sag_columns, "sag.csv");
    const auto swings = finished.rows(swing_columns, "swing.csv");
    const auto fits = finished.rows(poisson_columns, "poisson.csv");
    finished.write("sag.csv", sag_columns, sags);
    finished.write("swing.csv", swing_columns, swings);
    finished.write("poisson.csv", poisson_columns, fits);
    finished.write("poisson_poses.csv", poisson_pose_columns, finished.rows(poisson_pose_columns, "poisson_poses.csv"));
    finished.write("valley.csv", valley_columns, finished.rows(valley_columns, "valley.csv"));
    const nlohmann::json json = {{"schema", 1},
                                 {"young_by_sag", json_of(sag_columns, sags)},
                                 {"young_exponents", exponents(sags)},
                                 {"volume_locking", volume_locking(sags)},
                                 {"young_by_frequency", json_of(swing_columns, swings)},
                                 {"poisson", json_of(poisson_columns, fits)}};
    finished.write("fit.json", json.dump(2) + "\n");
    finished.write("fit.md", "# The fit\n\n" + young_markdown(sags) + swing_markdown(swings) + poisson_markdown(fits));
    return {summary(sags, fits), true};
}

}  // namespace

Study fit_study()
{
    return {"fit", plan, full_in_short, conclude};
}

}  // namespace experiments
