#include "experiments/studies/fit/fit_report.hpp"

#include "analysis/records/atomic_file.hpp"
#include "analysis/line_fit.hpp"
#include "experiments/studies/fit/fit_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using analysis::CsvTable;

struct SagRow {
    double vertices, mean_edge_m, k_stretch, k_volume, iterations, young_pa, low_pa, high_pa, misfit_pct, number;
    bool settled, identifiable;
};

std::vector<SagRow> sag_rows(const CsvTable& table)
{
    std::vector<SagRow> rows;
    for (int r = 0; r < table.rows(); ++r) {
        const auto number = [&](const char* column) { return table.number(r, column); };
        rows.push_back({number("vertices"), number("mean_edge_m"), number("k_stretch"), number("k_volume"), number("iterations"),
                        number("young_pa"), number("young_low_pa"), number("young_high_pa"), number("misfit_pct"),
                        number("young_dt2_over_density_edge2_iterations"), number("settled") == 1.0, number("identifiable") == 1.0});
    }
    return rows;
}

// The exponent of what `x` reads off rows that are alike in all else; nothing for fewer than two settled ones.
nlohmann::json exponent(const std::vector<SagRow>& rows, double SagRow::*x)
{
    std::vector<double> xs, young;
    for (const SagRow& row : rows)
        if (row.settled) xs.push_back(row.*x), young.push_back(row.young_pa);
    if (xs.size() < 2) return nullptr;
    return analysis::observed_order(xs, young).slope.estimate;
}

// What Young's modulus goes with, for each k_stretch: the iterations on the finest mesh, the mean edge at 24 iterations.
nlohmann::json exponents(const std::vector<SagRow>& rows)
{
    nlohmann::json json = nlohmann::json::array();
    std::set<std::pair<double, double>> stiffnesses;
    double finest = 0.0;
    for (const SagRow& row : rows) stiffnesses.insert({row.k_volume, row.k_stretch}), finest = std::max(finest, row.vertices);
    for (const auto& [k_volume, k_stretch] : stiffnesses) {
        std::vector<SagRow> over_iterations, over_edge;
        for (const SagRow& row : rows) {
            if (row.k_volume != k_volume || row.k_stretch != k_stretch) continue;
            if (row.vertices == finest) over_iterations.push_back(row);
            if (row.iterations == 24.0) over_edge.push_back(row);
        }
        json.push_back({{"k_volume", k_volume},
                        {"k_stretch", k_stretch},
                        {"of_iterations", exponent(over_iterations, &SagRow::iterations)},
                        {"of_mean_edge", exponent(over_edge, &SagRow::mean_edge_m)},
                        {"of_time_step", -2.0}});
    }
    return json;
}

// Sag with volume constraints over sag without: 5/6 where they do what incompressibility does to a body of the same shear modulus whose
// central forces make nu = 1/4 (E = 2.5 mu against 3 mu); less is locking.
nlohmann::json volume_locking(const std::vector<SagRow>& rows)
{
    nlohmann::json json = nlohmann::json::array();
    for (const SagRow& with : rows)
        for (const SagRow& without : rows)
            if (with.k_volume == 1.0 && without.k_volume == 0.0 && with.settled && without.settled && with.vertices == without.vertices &&
                with.k_stretch == without.k_stretch && with.iterations == without.iterations)
                json.push_back({{"vertices", with.vertices},
                                {"k_stretch", with.k_stretch},
                                {"iterations", with.iterations},
                                {"sag_over_sag_without_volume", without.young_pa / with.young_pa},
                                {"unlocked", 5.0 / 6.0}});
    return json;
}

std::string young_markdown(const std::vector<SagRow>& rows)
{
    std::string text =
        "## What k_stretch is worth\n\nYoung's modulus of the linear elastic bar (P2, nu 0.45, the same tets, the same vertices held) "
        "that sags as PBS does: k_volume 1, masses lumped, density 1000 kg/m^3, time step 10 ms. Every figure goes with density / "
        "(time step)^2 exactly. The interval leaves out one fifth of the bar at a time; the misfit is what no modulus removes.\n\n"
        "| vertices | mean edge [mm] | k_stretch | iterations | E [kPa] | interval [kPa] | misfit [%] | E dt^2 / (density edge^2 "
        "iterations) |\n|---|---|---|---|---|---|---|---|\n";
    for (const SagRow& row : rows)
        if (row.k_volume == 1.0)
            text += row.settled
                        ? fmt::format("| {:g} | {:.1f} | {:g} | {:g} | {:.4g} | {:.4g} to {:.4g} | {:.2g} | {:.3g} |{}\n", row.vertices,
                                      1e3 * row.mean_edge_m, row.k_stretch, row.iterations, row.young_pa / 1e3, row.low_pa / 1e3,
                                      row.high_pa / 1e3, row.misfit_pct, row.number, row.identifiable ? "" : " not identifiable")
                        : fmt::format("| {:g} | {:.1f} | {:g} | {:g} | no state of rest was found | | | |\n", row.vertices,
                                      1e3 * row.mean_edge_m, row.k_stretch, row.iterations);
    return text;
}

std::string swing_markdown(const CsvTable& swings)
{
    std::string text =
        "\n## The same by the first frequency\n\nThe bar let go from its sag at 0.1 % of its length; zero crossings of the tip. "
        "*expected* is what the recurrence of Algorithm 1 makes of the sag's modulus at that time step.\n\n"
        "| vertices | k_stretch | iterations | time step [ms] | frequency [Hz] | damping ratio | E [kPa] | E by sag [kPa] | ratio | "
        "expected |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for (int r = 0; r < swings.rows(); ++r) {
        const auto number = [&](const char* column) { return swings.number(r, column); };
        const std::string head = fmt::format("| {:g} | {:g} | {:g} | {:g} |", number("vertices"), number("k_stretch"), number("iterations"),
                                             1e3 * number("time_step_s"));
        if (swings.text_at(r, "outcome") == "finished")
            text += head + fmt::format(" {:.4g} | {:.3g} | {:.4g} | {:.4g} | {:.4f} | {:.4f} |\n", number("frequency_hz"),
                                       number("damping_ratio"), number("young_pa") / 1e3, number("young_sag_pa") / 1e3,
                                       number("young_over_sag"), number("expected_over_sag"));
        else
            text += head + " " + swings.text_at(r, "outcome") + " | | | | | |\n";
    }
    return text;
}

std::string verdict_of(const CsvTable& fits, int r)
{
    if (fits.number(r, "identifiable") == 1.0) return "";
    const std::string& outcome = fits.text_at(r, "outcome");
    if (outcome == "at_lower_bound" || outcome == "at_upper_bound") return "not identifiable: the bound is nearest";
    if (outcome == "converged")
        return fmt::format("not identifiable: 10 % of nu change the misfit by {:.2g} of itself", fits.number(r, "rise"));
    return "not identifiable: " + outcome;
}

std::string poisson_markdown(const CsvTable& fits)
{
    std::string text =
        "\n## Poisson's ratio\n\nThe nu of the finite elements nearest to PBS over all poses (error_joint, root mean square); the interval "
        "leaves out one pose at a time. Young's modulus cancels. The misfit is what no nu removes.\n\n"
        "| elements | attachment | body | k_stretch | nu | interval | misfit [%] | misfit at nu 0 | at the highest nu that converged | |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n";
    for (int r = 0; r < fits.rows(); ++r) {
        const auto number = [&](const char* column) { return fits.number(r, column); };
        text += fmt::format(
            "| {} P{}, {} | {} | {}, {} iterations | {:g} | {:.3f} | {:.3f} to {:.3f} | {:.3g} | {:.3g} | {:.3g} at {:.4g} | {} |\n",
            fits.text_at(r, "model"), fits.text_at(r, "element_order"), fits.text_at(r, "formulation"), fits.text_at(r, "attachment"),
            fits.text_at(r, "body"), fits.text_at(r, "iterations"), number("k_stretch"), number("poisson"), number("poisson_low"),
            number("poisson_high"), number("misfit_pct"), number("misfit_at_0_pct"), number("misfit_at_highest_pct"),
            number("highest_poisson"), verdict_of(fits, r));
    }
    return text;
}

nlohmann::json rows_json(const CsvTable& table)
{
    nlohmann::json json = nlohmann::json::array();
    for (int r = 0; r < table.rows(); ++r) {
        nlohmann::json row;
        for (const std::string& column : table.columns()) {
            const std::string& text = table.text_at(r, column);
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            if (!text.empty() && *end == '\0' && std::isfinite(value))
                row[column] = value;
            else
                row[column] = text;
        }
        json.push_back(row);
    }
    return json;
}

std::string summary(const std::vector<SagRow>& rows, const CsvTable& fits)
{
    std::string text = "fit: Young's modulus of a bar, k_volume 1, 24 iterations, time step 10 ms, density 1000 kg/m^3 [kPa]\n";
    double finest = 0.0;
    for (const SagRow& row : rows) finest = std::max(finest, row.vertices);
    for (const SagRow& row : rows)
        if (row.k_volume == 1.0 && row.iterations == 24.0 && row.settled)
            text += fmt::format("  {:g} vertices, k_stretch {:<4g} {:10.4g}\n", row.vertices, row.k_stretch, row.young_pa / 1e3);
    int identifiable = 0;
    for (int r = 0; r < fits.rows(); ++r) identifiable += fits.number(r, "identifiable") == 1.0;
    text += fmt::format("fit: Poisson's ratio identifiable in {} of {} fits; see fit.md\n", identifiable, fits.rows());
    return text;
}

}  // namespace

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

std::string write_fit_report(const FinishedRuns& finished)
{
    for (const char* file : {"sag.csv", "swing.csv", "poisson.csv", "poisson_poses.csv", "valley.csv"})
        finished.write(file, finished.gathered(file));
    const CsvTable sags = finished.gathered("sag.csv"), swings = finished.gathered("swing.csv"), fits = finished.gathered("poisson.csv");

    const std::vector<SagRow> rows = sag_rows(sags);
    const nlohmann::json json = {{"schema", 1},
                                 {"young_by_sag", rows_json(sags)},
                                 {"young_exponents", exponents(rows)},
                                 {"volume_locking", volume_locking(rows)},
                                 {"young_by_frequency", rows_json(swings)},
                                 {"poisson", rows_json(fits)}};
    finished.write("fit.json", json.dump(2) + "\n");
    finished.write("fit.md", "# The fit\n\n" + young_markdown(rows) + swing_markdown(swings) + poisson_markdown(fits));
    return summary(rows, fits);
}

}  // namespace experiments
