// Two solvers of systems whose factor does not fit in memory, compared with CHOLMOD on the same cantilever: conjugate
// gradients with algebraic multigrid in this process, and the program pbskin_distributed on one and two ranks. If that
// program is not in this program's folder or mpirun is not installed, one row states that the comparison was not made.
#include "reference_fem/verification/problems.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "pbs/geometry/child_process.hpp"

#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace reference_fem {
namespace {

namespace fs = std::filesystem;

// A residual r is an error of at most |r| over the lowest eigenvalue; a uniform load f across a cantilever has 0.78 of
// itself in that eigenvalue's mode (R. Blevins, Formulas for natural frequency and mode shape, 1979, Table 8-1), so
// |error| <= |r| / (0.78 |f|) |solution|.
constexpr double mode_share = 0.78;
const std::string bound_text =
    "both solutions' relative residuals over 0.78, the share of a uniform load in a cantilever's first mode";

// Whether a shell command succeeds. It ends with this process, and so does a program that takes the place of its shell
// (exec).
bool succeeds(const std::string& command)
{
    pbs::ChildProcess shell([&] {
        execl("/bin/sh", "sh", "-c", (command + " >/dev/null 2>&1").c_str(), nullptr);
        return pbs::ChildEnd{"", EXIT_FAILURE};
    });
    return shell.wait() == 0;
}

struct Answer {
    nlohmann::json record;
    Eigen::MatrixXd displacement;  // [m], #nodes x 3
};

class Program {
public:
    Program() : path_(fs::read_symlink("/proc/self/exe").parent_path() / "pbskin_distributed") {}

    bool is_installed() const { return fs::exists(path_) && succeeds("command -v mpirun"); }

    // Without mpirun where ranks is 0.
    std::optional<Answer> solve(int ranks, int element_order, const std::string& arguments) const
    {
        const analysis::ScratchFolder folder;
        const std::string launch =
            ranks ? "mpirun --allow-run-as-root --oversubscribe -n " + std::to_string(ranks) + " " : "";
        if (!succeeds("exec " + launch + "'" + path_.string() + "' --bar 3000 --gravity 0 0 -9.81 --order " +
                      std::to_string(element_order) + " --nodes -o " + folder.path().string() + " " + arguments))
            return {};
        return Answer{analysis::read_record(folder / "record.json"), displacement_in(folder / "nodes.csv")};
    }

private:
    static Eigen::MatrixXd displacement_in(const std::string& file)
    {
        const analysis::CsvTable table = analysis::read_csv(file);
        Eigen::MatrixXd displacement(table.rows(), 3);
        for (int c = 0; c < 3; ++c) {
            const std::vector<double> column = table.numbers(c == 0 ? "x_m" : c == 1 ? "y_m" : "z_m");
            displacement.col(c) = Eigen::Map<const Eigen::VectorXd>(column.data(), table.rows());
        }
        return displacement;
    }

    fs::path path_;
};

const Divisions divisions = {31, 4, 4};
const std::string source = "CHOLMOD, one process";

// setting: the identifier of these processes. residuals: the sum of both solutions' relative ones.
VerificationRow row_of(int element_order, const std::string& processes, const std::string& setting, int dofs,
                       double difference, double residuals)
{
    VerificationRow row = row_about(
        {"distributed", elements_of(element_order), linear_material(0.3), text_of(divisions), 1.0 / divisions[1], dofs},
        {"node_difference", "node differences over displacements, root mean square, " + processes, setting}, difference,
        0.0, "1", source);
    bound(row, 0.0, residuals / mode_share, bound_text);
    return row;
}

VerificationRow multigrid_row(const Effort& effort, int element_order)
{
    const pbs::TetMesh mesh = box_mesh({0, 0, 0}, {10, 1, 1}, divisions);
    BoundaryValueProblem problem;
    problem.body_force = [](const pbs::Vec3&) -> pbs::Vec3 { return {0, 0, -9810.0}; };
    problem.held = [](const pbs::Vec3& x) { return x.x() < 1e-9; };
    problem.element_order = element_order;
    const BoundaryValueSolution direct = solve(mesh, {1e5, 0.3}, problem);
    problem.solver = LinearSolver::cg_ml;
    const BoundaryValueSolution iterative = solve(mesh, solver_material(effort, {1e5, 0.3}), problem);
    return row_of(element_order, "cg_ml in one process", "cg_ml", direct.space->dofs(),
                  (iterative.displacement - direct.displacement).norm() / direct.displacement.norm(),
                  iterative.residual + direct.residual);
}

VerificationRow distributed_row(int element_order, int ranks, const std::optional<Answer>& direct,
                                const std::optional<Answer>& distributed)
{
    const std::string processes = std::to_string(ranks) + (ranks == 1 ? " rank" : " ranks"),
                      setting = "ranks_" + std::to_string(ranks);
    if (!direct || !distributed) return row_of(element_order, processes, setting, 0, not_reached, 0.0);
    const auto residual_of = [](const Answer& answer) { return answer.record["relative_residual"].get<double>(); };
    VerificationRow row =
        row_of(element_order, processes, setting, direct->record["dofs"].get<int>(),
               (distributed->displacement - direct->displacement).norm() / direct->displacement.norm(),
               residual_of(*direct) + residual_of(*distributed));
    row.note = std::to_string(distributed->record["iterations"].get<int>()) + " iterations; at least " +
               std::to_string(distributed->record["tets_of_rank_min"].get<int>()) + " tets a rank";
    return row;
}

}  // namespace

VerificationRows distributed_rows(const Effort& effort)
{
    VerificationRows rows = {multigrid_row(effort, 1), multigrid_row(effort, 2)};
    const Program program;
    if (!program.is_installed()) {
        rows.push_back(row_about({"distributed", {}, {}, text_of(divisions), 0.0, 0},
                                 {"several_processes", "several processes, P1 and P2"}, 0.0, 0.0, "1", source));
        rows.back().note = "pbskin_distributed is not in the folder of this program, or mpirun is not installed";
        return rows;
    }
    const ElasticMaterial material = solver_material(effort, {1e5, 0.3});
    const std::string arguments =
        "--young " + analysis::number_text(material.young_pa) + " --poisson " + analysis::number_text(material.poisson);
    for (const int element_order : {1, 2}) {
        const auto direct = program.solve(0, element_order, "--solver cholmod");
        for (const int ranks : {1, 2}) {
            const auto distributed = program.solve(ranks, element_order, arguments);
            rows.push_back(distributed_row(element_order, ranks, direct, distributed));
        }
    }
    return rows;
}

}  // namespace reference_fem
