#include "experiments/studies/timing/equal_quality.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/batched/pose_projection.hpp"
#include "pbs/solver/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace experiments {
namespace {

constexpr int layers = 25, across = 9;
constexpr double half_length = 1.0, first_radius = 0.24, last_radius = 0.12;  // [m]

int vertex(const std::array<int, 3>& at)
{
    return (at[0] * across + at[1]) * across + at[2];
}

// The square [-1, 1]^2 becomes a disc of radius one: (u sqrt(1 - v^2 / 2), v sqrt(1 - u^2 / 2)).
pbs::Positions grid_points()
{
    pbs::Positions points(layers * across * across, 3);
    for (int i = 0; i < layers; ++i)
        for (int j = 0; j < across; ++j)
            for (int k = 0; k < across; ++k) {
                const double along = double(i) / (layers - 1), u = 2.0 * j / (across - 1) - 1.0, v = 2.0 * k / (across - 1) - 1.0;
                const double radius = std::lerp(first_radius, last_radius, along);
                points.row(vertex({i, j, k})) << half_length * (2.0 * along - 1.0), radius * u * std::sqrt(1.0 - v * v / 2.0),
                    radius * v * std::sqrt(1.0 - u * u / 2.0);
            }
    return points;
}

// Each of the six tets of a cube follows a path along the axes, in one of their orders, from the first corner to the last.
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

}  // namespace

pbs::Character tapered_limb()
{
    pbs::Character limb;
    limb.name = "tapered_limb";
    limb.mesh.rest = grid_points();
    limb.mesh.tets = grid_tets(limb.mesh.rest);
    const pbs::Vec3 end(half_length, 0.0, 0.0);
    limb.skeleton = {{{"upper", -1, -end, pbs::Vec3::Zero()}, {"forearm", 0, pbs::Vec3::Zero(), end}}};
    limb.binding = pbs::bind_to_nearest_bone(limb.mesh.rest, limb.skeleton);
    limb.weights = pbs::paper_weights(limb.binding, limb.skeleton);
    for (int i = 0; i < limb.weights.vertices(); ++i) limb.blended.push_back(limb.weights.blended(i));
    return limb;
}

namespace {

struct PosedBody {
    explicit PosedBody(const EqualQualityCase& of)
        : character(of.is_tapered ? tapered_limb() : pbs::make_character(of.scene.character)),
          options(options_of<pbs::PbsOptions>(spec_of(of.scene, "pbs")))
    {
        const pbs::Motion motion = make_motion(of.scene.motion, character.skeleton, of.scene.file);
        const pbs::Pose& pose = motion.steps.at(static_cast<std::size_t>(of.frame) * motion.steps_per_frame);
        lbs = blended(character, pose);
        bind_points = pbs::posed_bind_points(character.binding, pose);
        options.jiggle.reset();
        options.sleep = false;
        options.threads = 1;
    }

    pbs::Character character;
    pbs::PbsOptions options;
    pbs::Positions lbs, bind_points;  // [m], #V x 3
};

// One order that is measured, and its timing of 24 iterations [ms per iteration and pose].
struct Contender {
    MeasuredOrder measured;
    TimedVariant turn;
};

double ms_per_iteration(const std::function<void()>& iterate)
{
    return 1e3 / paper_iterations * cpu_seconds([&] {
               for (int iteration = 0; iteration < paper_iterations; ++iteration) iterate();
           });
}

template <typename Scalar>
Contender alone(const PosedBody& body, const pbs::ConstraintSet<Scalar>& constraints, pbs::Order order, int most,
                const IterationMetrics& metrics)
{
    pbs::PbsOptions options = body.options;
    options.order = order;
    const std::shared_ptr<pbs::Projection<Scalar>> projection = pbs::make_projection(constraints, body.character.mesh.tets, options);
    Contender contender{{.order = name_of(order), .path = follow(*projection, body.lbs, body.bind_points, most, metrics)}, {}};
    contender.turn = [projection, &body] {
        projection->load(body.lbs, body.bind_points, pbs::local_origin<Scalar>(body.lbs));
        return std::vector{ms_per_iteration([&] {
            projection->project_bind_constraints();
            projection->project_stretch_constraints();
            projection->project_volume_constraints();
        })};
    };
    return contender;
}

template <typename Scalar>
struct SixteenPoses {
    SixteenPoses(const PosedBody& body, const pbs::ConstraintSet<Scalar>& constraints)
        : program(pbs::make_pose_program(constraints, body.character.mesh.tets, {}, pbs::Order::ordered)),
          block(program, std::vector<pbs::PbsOptions>(pbs::poses_a_block, body.options))
    {
    }
    SixteenPoses(const SixteenPoses&) = delete;  // the block points to the program

    pbs::PoseProgram<Scalar> program;
    pbs::PoseBlock<Scalar> block;
};

// path: that of `ordered`, whose bits each pose gets.
template <typename Scalar>
Contender side_by_side(const PosedBody& body, const pbs::ConstraintSet<Scalar>& constraints, const IterationPath& path)
{
    const auto poses = std::make_shared<SixteenPoses<Scalar>>(body, constraints);
    Contender contender{{.order = "poses", .path = path}, {}};
    contender.turn = [poses, &body] {
        const pbs::Vec3 origin = pbs::local_origin<Scalar>(body.lbs);
        for (int lane = 0; lane < pbs::poses_a_block; ++lane) poses->block.load(lane, body.lbs, body.bind_points, origin);
        return std::vector{ms_per_iteration([&] {
                               poses->block.project_bind_constraints();
                               poses->block.project_stretch_constraints();
                               poses->block.project_volume_constraints();
                           }) /
                           pbs::poses_a_block};
    };
    return contender;
}

template <typename Scalar>
void append(const EqualQualityCase& of, const PosedBody& body, const IterationMetrics& metrics, pbs::Precision precision,
            std::vector<Contender>& contenders)
{
    const auto add = [&](const std::string& sequence, const pbs::ConstraintSet<Scalar>& constraints) {
        const std::size_t first = contenders.size();
        for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped})
            contenders.push_back(alone(body, constraints, order, of.most_iterations, metrics));
        contenders.push_back(side_by_side(body, constraints, contenders[first + 1].measured.path));
        for (std::size_t i = first; i < contenders.size(); ++i) {
            contenders[i].measured.precision = name_of(precision);
            contenders[i].measured.sequence = sequence;
        }
    };
    const auto in_file_order = pbs::make_constraint_set<Scalar>(body.character.mesh, body.character.binding.distance, {}, body.options);
    add(file_sequence, in_file_order);
    pbs::ConstraintSet<Scalar> spread = in_file_order;
    in_spread_sequence(spread);
    add(spread_sequence, spread);
    for (const int seed : of.random) {
        pbs::ConstraintSet<Scalar> shuffled = in_file_order;
        in_random_sequence(shuffled, static_cast<unsigned>(seed));
        add(fmt::format("random_{}", seed), shuffled);
    }
}

}  // namespace

nlohmann::json to_json(const EqualQualityCase& of)
{
    static const auto fields = OptionFields<EqualQualityCase>("equal_quality")
                                   .record("of", &EqualQualityCase::of)
                                   .record("scene", &EqualQualityCase::scene)
                                   .record("frame", &EqualQualityCase::frame)
                                   .record("is_tapered", &EqualQualityCase::is_tapered)
                                   .record("random", &EqualQualityCase::random)
                                   .record("most_iterations", &EqualQualityCase::most_iterations)
                                   .record("rounds", &EqualQualityCase::rounds)
                                   .complete();
    return fields.json(of);
}

std::vector<MeasuredOrder> measure_orders(const EqualQualityCase& of)
{
    const PosedBody body(of);
    const IterationMetrics metrics(body.character, body.bind_points);
    std::vector<Contender> contenders;
    append<float>(of, body, metrics, pbs::Precision::f32, contenders);
    append<double>(of, body, metrics, pbs::Precision::f64, contenders);

    std::vector<TimedVariant> turns;
    for (const Contender& contender : contenders) turns.push_back(contender.turn);
    const std::vector<Samples> samples = take_turns(turns, of.rounds);
    std::vector<MeasuredOrder> measured;
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        measured.push_back(std::move(contenders[i].measured));
        measured.back().ms_iteration = spread_of(samples[i][0]);
    }
    return measured;
}

namespace {

using analysis::CaseKey;
using analysis::Columns;
using analysis::within;

CaseKey key_of(CaseKey of, const MeasuredOrder& measured)
{
    of.order = measured.order;
    of.precision = measured.precision;
    return of;
}

const IterationPath& plain_in_file_order(const std::vector<MeasuredOrder>& measured, const std::string& precision)
{
    const auto found = std::find_if(measured.begin(), measured.end(), [&](const MeasuredOrder& one) {
        return one.order == "plain" && one.sequence == file_sequence && one.precision == precision;
    });
    if (found == measured.end()) throw std::logic_error("no plain in file order and " + precision);
    return found->path;
}

struct Target {
    const char* name;
    double Look::*value;
    double bound;
};

std::vector<Target> targets(const IterationPath& plain)
{
    const Look& after_24 = look_at(plain, paper_iterations);
    return {{"residual_of_plain", &Look::combined, after_24.combined},
            {"volume_of_plain", &Look::volume_abs_change_pct, after_24.volume_abs_change_pct},
            {"volume_2_pct", &Look::volume_abs_change_pct, 2.0},
            {"volume_05_pct", &Look::volume_abs_change_pct, volume_tolerance_pct}};
}

const Columns<CaseKey>& order_key_columns()
{
    static const Columns<CaseKey> columns = {{"body", &CaseKey::body, "", "name of the body"},
                                             {"motion", &CaseKey::motion, "", "twist, or the name of a clip"},
                                             {"pose", &CaseKey::pose, "", "name of a pose in a clip"},
                                             {"angle_deg", &CaseKey::angle_deg, "deg", "angle of the joint that is twisted"},
                                             {"order", &CaseKey::order, "", "plain, ordered, grouped or poses"},
                                             {"precision", &CaseKey::precision, "", "f32 or f64"}};
    return columns;
}

}  // namespace

const Columns<OrderRow> order_columns =
    within(&OrderRow::of, order_key_columns()) +
    Columns<OrderRow>{{"sequence", &OrderRow::sequence, "", "of the constraints: file, spread, random_SEED"}} +
    within(&OrderRow::ms_iteration, spread_columns("iteration_ms", "ms", "one iteration of one pose, processor time of one thread")) +
    Columns<OrderRow>{
        {"residual_24", &OrderRow::residual_24, "", "combined residual after 24 iterations"},
        {"volume_abs_change_24_pct", &OrderRow::volume_abs_change_24_pct, "%", "absolute volume change after 24 iterations"},
        {"residual_limit", &OrderRow::residual_limit, "", "combined residual after the last iteration"},
        {"volume_abs_change_limit_pct", &OrderRow::volume_abs_change_limit_pct, "%", "absolute volume change after the last iteration"},
        {"residual_half", &OrderRow::residual_half, "", "combined residual after half of the iterations"},
        {"volume_abs_change_half_pct", &OrderRow::volume_abs_change_half_pct, "%", "absolute volume change after half of the iterations"},
        {"iterations", &OrderRow::iterations, "", "number of the last iteration"}};

const Columns<TargetRow> target_columns =
    within(&TargetRow::of, order_key_columns()) +
    Columns<TargetRow>{{"sequence", &TargetRow::sequence, "", "of the constraints: file, spread, random_SEED"},
                       {"target", &TargetRow::target, "",
                        "residual_of_plain or volume_of_plain after 24 iterations in file order; volume_2_pct, volume_05_pct"},
                       {"bound", &TargetRow::bound, "", "value of the target: a ratio, of a volume in %"},
                       {"reached", &TargetRow::reached, "", "whether the value was ever at or below the bound"},
                       {"iterations", &TargetRow::iterations, "", "until then"},
                       {"ms", &TargetRow::ms, "ms", "time of these iterations, one thread, per pose"},
                       {"limit", &TargetRow::limit, "", "the value after the last iteration: a ratio, of a volume in %"}};

std::optional<int> first_within(const IterationPath& path, double Look::*value, double bound)
{
    const auto found = std::find_if(path.looks.begin(), path.looks.end(), [&](const Look& look) { return look.*value <= bound; });
    return found == path.looks.end() ? std::nullopt : std::optional(found->iteration);
}

std::vector<OrderRow> order_rows(const CaseKey& of, const std::vector<MeasuredOrder>& measured)
{
    std::vector<OrderRow> rows;
    for (const MeasuredOrder& one : measured) {
        const Look &last = one.path.looks.back(), &half = look_at(one.path, last.iteration / 2),
                   &after_24 = look_at(one.path, paper_iterations);
        rows.push_back({key_of(of, one), one.sequence, one.ms_iteration, after_24.combined, after_24.volume_abs_change_pct, last.combined,
                        last.volume_abs_change_pct, half.combined, half.volume_abs_change_pct, last.iteration});
    }
    return rows;
}

std::vector<TargetRow> target_rows(const CaseKey& of, const std::vector<MeasuredOrder>& measured)
{
    std::vector<TargetRow> rows;
    for (const MeasuredOrder& one : measured)
        for (const Target& target : targets(plain_in_file_order(measured, one.precision))) {
            TargetRow row{key_of(of, one), one.sequence, target.name, target.bound};
            row.iterations = first_within(one.path, target.value, target.bound);
            row.reached = row.iterations.has_value();
            if (row.iterations) row.ms = *row.iterations * one.ms_iteration.median;
            row.limit = one.path.looks.back().*target.value;
            rows.push_back(row);
        }
    return rows;
}

const Columns<EqualAnswer> answer_columns =
    within(&EqualAnswer::of, order_key_columns()) +
    Columns<EqualAnswer>{
        {"target", &EqualAnswer::target, "", "as in targets.csv"},
        {"bound", &EqualAnswer::bound, "", "value of the target: a ratio, of a volume in %"},
        {"iterations", &EqualAnswer::iterations, "", "until the target is reached in file order"},
        {"ms", &EqualAnswer::ms, "ms", "time of these iterations"},
        {"limit", &EqualAnswer::limit, "", "the value after the last iteration in file order: a ratio, of a volume in %"},
        {"speedup_to_plain", &EqualAnswer::speedup_to_plain, "", "time of plain in file order to the same target over this one's"},
        {"speedup_to_plain_spread", &EqualAnswer::speedup_to_plain_spread, "", "time of plain in the spread sequence over this one's"}};

std::vector<EqualAnswer> equal_answers(const std::vector<TargetRow>& rows)
{
    // Nothing if either never reaches the target. std::out_of_range without the sequence.
    const auto speedup = [&](const TargetRow& row, const std::string& sequence) -> std::optional<double> {
        CaseKey of_plain = row.of;
        of_plain.order = "plain";
        const auto plain = std::ranges::find_if(
            rows, [&](const TargetRow& one) { return one.of == of_plain && one.target == row.target && one.sequence == sequence; });
        if (plain == rows.end()) throw std::out_of_range("no rows of plain in the sequence " + sequence);
        return plain->ms && row.ms && *row.ms > 0.0 ? std::optional(*plain->ms / *row.ms) : std::nullopt;
    };
    std::vector<EqualAnswer> all;
    for (const TargetRow& row : rows)
        if (row.sequence == file_sequence)
            all.push_back({row.of, row.target, row.bound, row.iterations, row.ms, row.limit, speedup(row, file_sequence),
                           speedup(row, spread_sequence)});
    return all;
}

std::string order_report(std::vector<OrderRow> orders, const std::vector<EqualAnswer>& answers)
{
    std::erase_if(orders, [](const OrderRow& row) { return row.sequence != file_sequence; });
    const std::string of = "body angle_deg:.0f pose order precision ";
    return "The first table has each order after 24 iterations and in the limit, in file order. Every time of plain is that of the order "
           "`plain`, which is built for the same bits on every machine.\n\n" +
           markdown_table(table_of(order_columns, orders),
                          analysis::report_columns(of + "iteration_ms:.4f residual_24:.4g volume_abs_change_24_pct:.3f residual_limit:.4g "
                                                        "volume_abs_change_limit_pct:.3f")) +
           "\nThe second table has the time to an equal answer. An empty cell states that the target is never reached, so that no speed-up "
           "exists.\n\n" +
           markdown_table(table_of(answer_columns, answers),
                          analysis::report_columns(of + "target bound:.4g iterations:.0f ms:.2f limit:.4g speedup_to_plain:.2f "
                                                        "speedup_to_plain_spread:.2f"));
}

std::string measure_equal_quality(const EqualQualityCase& of, const std::string& folder)
{
    const std::vector<MeasuredOrder> measured = measure_orders(of);
    table_of(order_columns, order_rows(of.of, measured)).write(analysis::path_in(folder, "orders.csv"));
    table_of(target_columns, target_rows(of.of, measured)).write(analysis::path_in(folder, "targets.csv"));
    for (const MeasuredOrder& one : measured)
        if (!one.path.finite) return one.order + " in the sequence " + one.sequence + " ceased to be finite";
    return {};
}

}  // namespace experiments
