#include "experiments/studies/equal_quality/equal_quality.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/equal_quality/tapered_limb.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/batched/pose_projection.hpp"
#include "pbs/solver/particles.hpp"

#include <fmt/format.h>

namespace experiments {
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

}  // namespace experiments
