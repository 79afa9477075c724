#include "experiments/studies/timing/timing.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/batched/pose_projection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <type_traits>

namespace experiments {
namespace {

const std::string tapered_name = "tapered_limb";
constexpr int layers = 25, across = 9;
constexpr double half_length = 1.0, first_radius = 0.24, last_radius = 0.12;  // [m]

int vertex(const std::array<int, 3>& at)
{
    return (at[0] * across + at[1]) * across + at[2];
}

// The vertices of a layer: the square [-1, 1]^2 becomes a disc of radius one by (u sqrt(1 - v^2 / 2), v sqrt(1 - u^2 /
// 2)).
pbs::Positions grid_points()
{
    pbs::Positions points(layers * across * across, 3);
    for (int i = 0; i < layers; ++i)
        for (int j = 0; j < across; ++j)
            for (int k = 0; k < across; ++k) {
                const double along = double(i) / (layers - 1), u = 2.0 * j / (across - 1) - 1.0,
                             v = 2.0 * k / (across - 1) - 1.0;
                const double radius = std::lerp(first_radius, last_radius, along);
                points.row(vertex({i, j, k})) << half_length * (2.0 * along - 1.0),
                    radius * u * std::sqrt(1.0 - v * v / 2.0), radius * v * std::sqrt(1.0 - u * u / 2.0);
            }
    return points;
}

// Each of the six tets of a cube follows a path along the axes, in one of their orders, from the first corner to the
// last.
pbs::Tets grid_tets(const pbs::Positions& points)
{
    pbs::Tets tets(6 * (layers - 1) * (across - 1) * (across - 1), 4);
    Eigen::Index t = 0;
    for (int i = 0; i + 1 < layers; ++i)
        for (int j = 0; j + 1 < across; ++j)
            for (int k = 0; k + 1 < across; ++k) {
                std::array<int, 3> axes = {0, 1, 2};
                do {
                    std::array<int, 3> corner = {i, j, k};
                    tets(t, 0) = vertex(corner);
                    for (int step = 0; step < 3; ++step) {
                        ++corner[axes[step]];
                        tets(t, step + 1) = vertex(corner);
                    }
                    ++t;
                } while (std::next_permutation(axes.begin(), axes.end()));
            }
    const Eigen::VectorXd volumes = pbs::tet_volumes(points, tets);
    for (t = 0; t < tets.rows(); ++t)
        if (volumes(t) < 0.0) std::swap(tets(t, 2), tets(t, 3));
    return tets;
}

// One order that is measured, and the loops of its timing.
struct Contender {
    MeasuredOrder measured;
    StepLoops loops;

    // [ms per iteration and pose]
    std::vector<double> turn() const
    {
        loops.load();
        const double seconds = cpu_seconds([&] {
            for (int iteration = 0; iteration < paper_iterations; ++iteration) loops.iterate();
        });
        return {1e3 * seconds / paper_iterations / (measured.order == "poses" ? pbs::poses_a_block : 1)};
    }
};

template <typename Scalar>
void append(const EqualQualityCase& quality_case, const pbs::Character& character, pbs::PbsOptions options,
            const StepStart& start, std::vector<Contender>& contenders)
{
    const pbs::Tets& tets = character.mesh.tets;
    const IterationMetrics metrics(character, start.bind_points);
    const auto add = [&](const std::string& sequence, const pbs::ConstraintSet<Scalar>& constraints) {
        const auto add_order = [&](const std::string& order, const StepLoops& loops, const IterationPath& path) {
            contenders.push_back({{order, name_of(options.precision), sequence, path}, loops});
        };
        IterationPath of_ordered;
        for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered}) {
            pbs::PbsOptions in_order = options;
            in_order.order = order;
            const StepLoops loops = step_loops(constraints, tets, in_order, start);
            add_order(name_of(order), loops, follow(loops, start.guess, quality_case.most_iterations, metrics));
            if (order == pbs::Order::ordered) of_ordered = contenders.back().measured.path;
        }
        add_order("poses", loops_of_poses(constraints, tets, options, start, 1), of_ordered);  // each pose has its bits
    };
    options.precision = std::is_same_v<Scalar, float> ? pbs::Precision::f32 : pbs::Precision::f64;
    const auto in_file_order =
        pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, {}, options);
    add(file_sequence, in_file_order);
    add(spread_sequence, in_spread_order(in_file_order));
    for (const int seed : quality_case.random) {
        pbs::ConstraintSet<Scalar> shuffled = in_file_order;
        in_random_sequence(shuffled, static_cast<unsigned>(seed));
        add(fmt::format("random_{}", seed), shuffled);
    }
}

using analysis::CaseKey;
using analysis::Columns;
using analysis::CsvTable;
using analysis::within;

struct Target {
    const char* name;
    double Look::*value;
    double bound;
};

// In this precision.
std::vector<Target> targets(const std::vector<MeasuredOrder>& measured, const std::string& precision)
{
    const auto plain = std::ranges::find_if(measured, [&](const MeasuredOrder& measured_order) {
        return measured_order.order == "plain" && measured_order.sequence == file_sequence &&
               measured_order.precision == precision;
    });
    if (plain == measured.end()) throw std::logic_error("no plain in file order and " + precision);
    const Look& after_24 = look_at(plain->path, paper_iterations);
    return {{"residual_of_plain", &Look::combined, after_24.combined},
            {"volume_of_plain", &Look::volume_abs_change_pct, after_24.volume_abs_change_pct},
            {"volume_2_pct", &Look::volume_abs_change_pct, 2.0},
            {"volume_05_pct", &Look::volume_abs_change_pct, analysis::kept_volume_pct}};
}

const Columns<CaseKey> order_key_columns = MEMBER_COLUMNS(CaseKey, body, motion, pose, angle_deg, order, precision);

Columns<OrderRow> look_columns(Look OrderRow::*look, const std::string& name)
{
    return within(look, Columns<Look>{{"residual_" + name, &Look::combined},
                                      {"volume_abs_change_" + name + "_pct", &Look::volume_abs_change_pct}});
}

}  // namespace

pbs::Character tapered_limb()
{
    const pbs::Vec3 end(half_length, 0.0, 0.0), middle = pbs::Vec3::Zero();
    pbs::TetMesh mesh{grid_points(), {}};
    mesh.tets = grid_tets(mesh.rest);
    return skinned_along(tapered_name, std::move(mesh), {{{"upper", -1, -end, middle}, {"forearm", 0, middle, end}}});
}

RECORD_SETTINGS(EqualQualityCase, of, scene, frame, random, most_iterations, rounds)

std::vector<MeasuredOrder> measure_orders(const EqualQualityCase& quality_case)
{
    const pbs::Character character =
        quality_case.of.body == tapered_name ? tapered_limb() : pbs::make_character(quality_case.scene.character);
    const pbs::Motion motion = make_motion(quality_case.scene.motion, character.skeleton, quality_case.scene.file);
    const pbs::Pose& pose = motion.steps.at(static_cast<std::size_t>(quality_case.frame) * motion.steps_per_frame);
    const pbs::Positions lbs = blended(character, pose), bind_points = pbs::posed_bind_points(character.binding, pose);
    pbs::PbsOptions options = options_of<pbs::PbsOptions>(spec_of(quality_case.scene, "pbs"));
    options.jiggle.reset();
    options.sleep = false;
    options.threads = 1;
    std::vector<Contender> contenders;
    append<float>(quality_case, character, options, {lbs, bind_points}, contenders);
    append<double>(quality_case, character, options, {lbs, bind_points}, contenders);

    std::vector<TimedVariant> turns;
    for (const Contender& contender : contenders) turns.push_back([&contender] { return contender.turn(); });
    const std::vector<Samples> samples = take_turns(turns, quality_case.rounds);
    std::vector<MeasuredOrder> measured;
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        measured.push_back(std::move(contenders[i].measured));
        measured.back().ms_iteration = spread_of(samples[i][0]);
    }
    return measured;
}

const Columns<OrderRow> order_columns =
    within(&OrderRow::of, order_key_columns) + Columns<OrderRow>{{"sequence", &OrderRow::sequence}} +
    within(&OrderRow::ms_iteration, spread_columns("iteration_ms")) + look_columns(&OrderRow::after_24, "24") +
    look_columns(&OrderRow::limit, "limit") + look_columns(&OrderRow::half, "half") +
    within(&OrderRow::limit, Columns<Look>{{"iterations", &Look::iteration}});

const Columns<TargetRow> target_columns =
    within(&TargetRow::of, order_key_columns) +
    MEMBER_COLUMNS(TargetRow, sequence, target, bound, reached, iterations, ms, limit);

std::optional<int> first_within(const IterationPath& path, double Look::*value, double bound)
{
    const auto found = std::ranges::find_if(path.looks, [&](const Look& look) { return look.*value <= bound; });
    return found == path.looks.end() ? std::nullopt : std::optional(found->iteration);
}

std::vector<OrderRow> order_rows(const CaseKey& key, const std::vector<MeasuredOrder>& measured)
{
    std::vector<OrderRow> rows;
    for (const MeasuredOrder& measured_order : measured) {
        const Look& last = measured_order.path.looks.back();
        rows.push_back({key, measured_order.sequence, measured_order.ms_iteration,
                        look_at(measured_order.path, paper_iterations), last,
                        look_at(measured_order.path, last.iteration / 2)});
        rows.back().of.order = measured_order.order;
        rows.back().of.precision = measured_order.precision;
    }
    return rows;
}

std::vector<TargetRow> target_rows(const CaseKey& key, const std::vector<MeasuredOrder>& measured)
{
    std::vector<TargetRow> rows;
    for (const MeasuredOrder& measured_order : measured)
        for (const Target& target : targets(measured, measured_order.precision)) {
            TargetRow& row = rows.emplace_back(TargetRow{key, measured_order.sequence, target.name, target.bound});
            row.of.order = measured_order.order;
            row.of.precision = measured_order.precision;
            row.iterations = first_within(measured_order.path, target.value, target.bound);
            row.reached = row.iterations.has_value();
            if (row.iterations) row.ms = *row.iterations * measured_order.ms_iteration.median;
            row.limit = measured_order.path.looks.back().*target.value;
        }
    return rows;
}

CsvTable equal_answers(const CsvTable& targets)
{
    const std::vector<std::string> kept = {"body",   "motion", "pose",       "angle_deg", "order", "precision",
                                           "target", "bound",  "iterations", "ms",        "limit"};
    std::vector<std::string> columns = kept;
    columns.insert(columns.end(), {"speedup_to_plain", "speedup_to_plain_spread"});
    CsvTable answers(columns, "answers.csv");
    for (const CsvTable::Row& row : targets.where("sequence", file_sequence)) {
        CsvTable::NamedCells of_plain = {{"order", "plain"}};
        for (const char* column : {"body", "motion", "pose", "angle_deg", "precision", "target"})
            of_plain.emplace_back(column, row.text(column));
        const CsvTable plain = targets.where(of_plain);
        std::vector<CsvTable::Cell> cells;
        for (const std::string& column : kept) cells.emplace_back(row.text(column));
        for (const std::string& sequence : {file_sequence, spread_sequence}) {
            const auto baseline = plain.find({{"sequence", sequence}});
            if (!baseline) row.refuse("sequence", "expected a row of plain in the sequence " + sequence);
            const auto ms = row.number_or_nothing("ms"), plain_ms = baseline->number_or_nothing("ms");
            cells.emplace_back(ms && plain_ms && *ms > 0.0 ? std::optional(*plain_ms / *ms) : std::nullopt);
        }
        answers.add_row(cells);
    }
    return answers;
}

std::string measure_equal_quality(const EqualQualityCase& quality_case, const std::string& folder)
{
    const std::vector<MeasuredOrder> measured = measure_orders(quality_case);
    table_of(order_columns, order_rows(quality_case.of, measured)).write(analysis::path_in(folder, "orders.csv"));
    table_of(target_columns, target_rows(quality_case.of, measured)).write(analysis::path_in(folder, "targets.csv"));
    for (const MeasuredOrder& measured_order : measured)
        if (!measured_order.path.finite)
            return measured_order.order + " in the sequence " + measured_order.sequence + " ceased to be finite";
    return {};
}

}  // namespace experiments
