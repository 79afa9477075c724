#include "experiments/studies/work_precision/newton_way.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/cpu_clock.hpp"
#include "experiments/process/interruption.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <algorithm>

namespace experiments {
namespace {

using analysis::within;

constexpr int most_steps = 35;                       // with more_steps those of a whole solve, which ends after 40 (NewtonOptions)
constexpr double last_pct = 0.01 * newton_goal_pct;  // the way is recorded to here
constexpr int more_steps = 5;                        // of a whole solve than of single steps, which may take another way

struct TimedShape {
    pbs::Positions positions;
    bool converged = false;
    double ms = 0.0;
};

struct InitialGuess {
    pbs::Positions positions;
    std::optional<double> ms = {};  // nothing where none is computed
};

// Newton's method in one pose, with a limited number of steps.
class NewtonSolve {
public:
    NewtonSolve(const PointSetting& flesh, const BodyMesh& mesh, const PosePair& poses, int steps) : poses_(poses)
    {
        DeformerSpec spec = flesh.spec;
        options_of<FemOptions>(spec).most_newton_steps = steps;
        deformer_ = make_deformer(spec);
        deformer_->reset(mesh.character());
    }

    TimedShape from(const pbs::Positions& shape)
    {
        stop_if_interrupted();
        deformer_->start_from(shape);
        const double start_s = process_cpu_s();
        const pbs::StepSummary step = deformer_->advance(poses_.pose, poses_.time_step_s);
        return {deformer_->positions(), step.outcome == pbs::Outcome::finished, 1e3 * (process_cpu_s() - start_s)};
    }

private:
    const PosePair& poses_;
    std::unique_ptr<Deformer> deformer_;
};

class NewtonWays {
public:
    NewtonWays(const WorkPrecisionCase& of, const PointSetting& flesh, const BodyMesh& mesh, const PosePair& poses,
               const pbs::Positions& limit, const PosedReference& reference)
        : of_(of), flesh_(flesh), mesh_(mesh), poses_(poses), limit_(limit), reference_(reference)
    {
    }

    std::vector<NewtonRow> rows() const
    {
        std::vector<NewtonRow> all;
        const auto add = [&](NewtonStart start, const std::optional<InitialGuess>& guess) {
            if (!guess || !guess->positions.allFinite()) return;
            for (const NewtonRow& row : rows_from(start, *guess)) all.push_back(row);
        };
        add(NewtonStart::smooth_dqs, smooth_dqs());
        add(NewtonStart::lbs, lbs());
        if (const auto row = row_from_rest()) all.push_back(*row);
        add(NewtonStart::frame_before, solution_of_frame_before());
        return all;
    }

private:
    double to_limit_pct(const pbs::Positions& shape) const { return reference_.distance(shape, limit_).joint_pct; }

    // Steps one by one, and whole solves with as many steps as the goal needs.
    std::vector<NewtonRow> rows_from(NewtonStart start, const InitialGuess& guess) const
    {
        std::vector<NewtonRow> rows = {{of_.of, start, 0, 0.0, {}, to_limit_pct(guess.positions), guess.ms}};
        NewtonSolve step(flesh_, mesh_, poses_, 1);
        step.from(guess.positions);  // analyses the pattern of the matrix
        TimedShape at{guess.positions};
        while (!at.converged && rows.back().to_limit_pct > last_pct && rows.back().newton_steps < most_steps) {
            at = step.from(at.positions);
            if (!at.positions.allFinite()) break;
            NewtonRow row = rows.back();
            ++row.newton_steps;
            *row.single_steps_ms += at.ms;
            row.to_limit_pct = to_limit_pct(at.positions);
            rows.push_back(row);
        }
        time_goal(rows, guess);
        return rows;
    }

    // No time is added for no steps.
    void time_goal(std::vector<NewtonRow>& rows, const InitialGuess& guess) const
    {
        const auto first = std::ranges::find_if(rows, [](const NewtonRow& row) { return row.to_limit_pct <= newton_goal_pct; });
        if (first == rows.end()) return;
        std::optional<NewtonSolve> solve;
        const auto distance_pct_after = [&](int steps) {
            if (steps == 0) return first->to_limit_pct;
            return to_limit_pct(solve.emplace(flesh_, mesh_, poses_, steps).from(guess.positions).positions);
        };
        first->timed_steps = steps_to_goal(first->newton_steps, distance_pct_after);
        if (!first->timed_steps) return;
        first->ms_median = guess.ms.value_or(0.0);
        if (*first->timed_steps > 0) *first->ms_median += median_ms([&] { return std::vector{solve->from(guess.positions).ms}; });
    }

    double median_ms(const TimedVariant& turn) const
    {
        const Rounds rounds = {.seconds = of_.newton_rounds.seconds / 5.0, .fewest = 3, .most = 9};
        return spread_of(take_turns({turn}, rounds)[0][0]).median;
    }

    // The initial guess of the deformers, which is their shape without an iteration. Nothing in a program without them.
    std::optional<InitialGuess> smooth_dqs() const
    {
        const auto entry = std::ranges::find(compared_deformers(), "quasi_newton", &ComparedDeformer::name);
        if (entry == compared_deformers().end() || !is_available(*entry)) return std::nullopt;
        const PointSetting setting{entry->name, spec_with(*entry, of_.scene, {.iterations = 0, .code = codes_of(*entry).back()}), 0};
        PosedDeformer deformer(setting, mesh_, poses_);
        const pbs::Positions positions = deformer.reach().positions;
        return InitialGuess{positions, median_ms([&] { return deformer.turn(); })};
    }

    InitialGuess lbs() const
    {
        const auto turn = [&] {
            const double start_s = process_cpu_s();
            blended(mesh_.character(), poses_.pose);
            return std::vector{1e3 * (process_cpu_s() - start_s)};
        };
        return {blended(mesh_.character(), poses_.pose), median_ms(turn)};
    }

    std::optional<NewtonRow> row_from_rest() const
    {
        const auto deformer = make_deformer(flesh_.spec);
        deformer->reset(mesh_.character());
        const double start_s = process_cpu_s();
        const pbs::StepSummary step = deformer->advance(poses_.pose, poses_.time_step_s);
        const double ms = 1e3 * (process_cpu_s() - start_s);
        if (step.outcome != pbs::Outcome::finished) return std::nullopt;
        return NewtonRow{of_.of, NewtonStart::rest, step.iterations, {}, ms, to_limit_pct(deformer->positions()), {}, step.iterations};
    }

    std::optional<InitialGuess> solution_of_frame_before() const
    {
        const auto deformer = make_deformer(flesh_.spec);
        deformer->reset(mesh_.character());
        const pbs::StepSummary step = deformer->advance(poses_.neighbour, poses_.time_step_s);
        if (step.outcome != pbs::Outcome::finished) return std::nullopt;
        return InitialGuess{deformer->positions()};
    }

    const WorkPrecisionCase& of_;
    const PointSetting& flesh_;
    const BodyMesh& mesh_;
    const PosePair& poses_;
    const pbs::Positions& limit_;
    const PosedReference& reference_;
};

}  // namespace

const analysis::Columns<NewtonRow> newton_columns =
    within(&NewtonRow::of, pose_columns()) +
    analysis::Columns<NewtonRow>{
        {"start", &NewtonRow::start, "",
         "initial guess: smooth_dqs (that of quasi_newton), lbs, rest (led to the pose in stages) or frame_before (its solution)"},
        {"newton_steps", &NewtonRow::newton_steps, "", "Newton's steps from the start to this state"},
        {"single_steps_ms", &NewtonRow::single_steps_ms, "ms",
         "sum of the processor times of these steps, each solved alone, which costs one more gradient per step"},
        {"ms_median", &NewtonRow::ms_median, "ms",
         "processor time of a whole solve to the first state within 1 % of the limit; empty for other states; from rest: until it "
         "converges; it contains guess_ms"},
        {"guess_ms", &NewtonRow::guess_ms, "ms", "processor time of the initial guess; empty where none is computed"},
        {"timed_steps", &NewtonRow::timed_steps, "",
         "Newton's steps of the whole solves behind ms_median: newton_steps, or up to 5 more where whole solves take another way"},
        {"to_linear_elements_joint_pct", &NewtonRow::to_limit_pct, "%",
         "distance at the joints from linear elements with the law of the deformers that minimise an energy, on the case's own tets"}};

std::vector<NewtonRow> newton_way(const WorkPrecisionCase& of, const PointSetting& flesh, const BodyMesh& mesh, const PosePair& poses,
                                  const pbs::Positions& limit, const PosedReference& reference)
{
    return NewtonWays(of, flesh, mesh, poses, limit, reference).rows();
}

std::optional<int> steps_to_goal(int first, const std::function<double(int)>& distance_pct_after)
{
    for (int steps = first; steps <= first + more_steps; ++steps)
        if (distance_pct_after(steps) <= newton_goal_pct) return steps;  // not a number is not within it
    return std::nullopt;
}

std::optional<NewtonRow> fastest_to_goal(const std::vector<NewtonRow>& rows)
{
    std::optional<NewtonRow> fastest;
    for (const NewtonRow& row : rows) {
        const bool reaches = is_cold(row.start) && row.ms_median.value_or(0.0) > 0.0 && row.to_limit_pct <= newton_goal_pct;
        if (reaches && (!fastest || *row.ms_median < *fastest->ms_median)) fastest = row;
    }
    return fastest;
}

std::optional<double> warm_to_goal_ms(const std::vector<NewtonRow>& rows)
{
    for (const NewtonRow& row : rows)
        if (!is_cold(row.start) && row.ms_median.value_or(0.0) > 0.0 && row.to_limit_pct <= newton_goal_pct) return row.ms_median;
    return std::nullopt;
}

}  // namespace experiments
