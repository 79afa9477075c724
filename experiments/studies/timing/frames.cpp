#include "experiments/studies/timing/timing.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/statistics/fits.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace experiments {
namespace {

// The parts of a frame, the samples of a turn [s].
enum FramePart {
    lbs_s,
    bind_s,
    stretch_s,
    volume_s,
    rest_s,
    total_s,
    total_wall_s,
    surface_s,
    drawn_wall_s,
    frame_parts
};

constexpr std::pair<pbs::Order, pbs::Precision> variants[] = {{pbs::Order::plain, pbs::Precision::f64},
                                                              {pbs::Order::plain, pbs::Precision::f32},
                                                              {pbs::Order::ordered, pbs::Precision::f32}};

pbs::PbsOptions without_iterations(pbs::PbsOptions options)
{
    options.iterations = 0;
    return options;
}

template <typename Scalar>
StepLoops loops_of(const pbs::Character& character, const std::vector<bool>& zone, const pbs::PbsOptions& options,
                   const StepStart& start)
{
    return step_loops(pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, zone, options),
                      character.mesh.tets, options, start);
}

// One variant on its way through the motion.
class VariantFrames {
public:
    VariantFrames(const pbs::Character& character, const pbs::PbsOptions& options)
        : character_(character),
          zone_(pbs::jiggle_zone(character.binding)),
          skinning_(character.mesh.rest, character.weights),
          solver_(character.mesh, character.binding.distance, zone_, options),
          idle_solver_(character.mesh, character.binding.distance, zone_, without_iterations(options)),
          loops_((options.precision == pbs::Precision::f32
                      ? loops_of<float>
                      : loops_of<double>)(character, zone_, options, {lbs_, bind_points_, false}))
    {
    }
    VariantFrames(const VariantFrames&) = delete;  // the loops read its members

    // Adds the seconds of a frame.
    void add_frame(const pbs::Pose& pose, std::vector<double>& seconds)
    {
        constexpr double time_step_s = 0.01;
        const auto bind_points = [&] { return pbs::posed_bind_points(character_.binding, pose); };
        const pbs::Stopwatch wall;
        const double lbs = cpu_seconds([&] { skinning_.linear(pose, lbs_); });
        seconds[lbs_s] += lbs;
        seconds[total_s] += lbs + cpu_seconds([&] { solver_.advance(lbs_, bind_points(), time_step_s); });
        seconds[total_wall_s] += wall.seconds();
        if (character_.surface) {
            seconds[surface_s] += cpu_seconds([&] {
                surface_ = pbs::embedded_positions(*character_.surface, solver_.positions(), character_.mesh.tets);
            });
            seconds[drawn_wall_s] += wall.seconds();
        }
        seconds[rest_s] += cpu_seconds([&] { idle_solver_.advance(lbs_, bind_points(), time_step_s); });

        // Each class by itself, which is for timing alone, from the frame's LBS.
        bind_points_ = bind_points();
        loops_.load();
        for (const auto& [sample, project] : {std::pair(volume_s, &loops_.volume),
                                              std::pair(stretch_s, &loops_.stretch), std::pair(bind_s, &loops_.bind)})
            seconds[sample] += cpu_seconds([project = project] {
                for (int iteration = 0; iteration < paper_iterations; ++iteration) (*project)();
            });
    }

private:
    const pbs::Character& character_;
    std::vector<bool> zone_;
    pbs::BlendSkinning<double> skinning_;
    pbs::PbsSolver solver_, idle_solver_;
    pbs::Positions lbs_, bind_points_, surface_;
    StepLoops loops_;
};

// How a part is recorded. is_value: it is a measurement of the run too.
struct RecordedPart {
    FramePart sample;
    Spread FrameTiming::*ms;
    const char* name;
    bool is_value = false;
};
constexpr RecordedPart recorded_parts[] = {{lbs_s, &FrameTiming::lbs_ms, "lbs_ms", true},
                                           {bind_s, &FrameTiming::bind_ms, "bind_ms", true},
                                           {stretch_s, &FrameTiming::stretch_ms, "stretch_ms", true},
                                           {volume_s, &FrameTiming::volume_ms, "volume_ms", true},
                                           {rest_s, &FrameTiming::rest_ms, "rest_ms"},
                                           {total_s, &FrameTiming::total_ms, "total_ms", true},
                                           {total_wall_s, &FrameTiming::total_wall_ms, "total_wall_ms"}};

using analysis::Columns;
using analysis::within;

constexpr double steps_in_1_s = 100.0;
constexpr double round_s_per_vertex = 24e-6;
constexpr int most_rounds = 61;

Columns<FrameTiming> frame_columns()
{
    Columns<FrameTiming> columns = MEMBER_COLUMNS(FrameTiming, variant, precision) +
                                   within(&FrameTiming::total_ms, Columns<Spread>{{"rounds", &Spread::rounds}});
    for (const RecordedPart& part : recorded_parts) columns = columns + within(part.ms, spread_columns(part.name));
    return columns + within(&FrameTiming::surface_ms, spread_columns("surface_ms")) +
           within(&FrameTiming::drawn_wall_ms, spread_columns("drawn_wall_ms"));
}

analysis::Measurement measured(const TimingRow& row, const std::string& quantity, double value, double low, double high,
                               const std::string& unit)
{
    const analysis::CaseKey key = {.body = row.body,
                                   .motion = "01_01",
                                   .deformer = "pbs",
                                   .variant = row.is_refined ? "refined" : "table_1",
                                   .order = row.timing.variant,
                                   .precision = row.timing.precision,
                                   .vertices = row.vertices,
                                   .model = row.model};
    return {"C10", quantity, key, value, low, high, unit};
}

analysis::Measurement frame_rate(const TimingRow& row, const std::string& quantity, const Spread& ms)
{
    return measured(row, quantity, 1e3 / ms.median, 1e3 / ms.upper, 1e3 / ms.lower, "1/s");
}

}  // namespace

std::vector<FrameTiming> time_frames(const pbs::Character& character, const pbs::Motion& motion, double k_jiggle,
                                     const Rounds& rounds, int frames_per_turn)
{
    std::vector<TimedVariant> turns;
    for (const auto& [order, precision] : variants) {
        pbs::PbsOptions options;
        options.iterations = paper_iterations;
        options.order = order;
        options.precision = precision;
        options.gravity_m_s2 = {0.0, -9.81, 0.0};
        options.jiggle = pbs::Jiggle{k_jiggle};
        turns.push_back([frames = std::make_shared<VariantFrames>(character, options), &motion, frames_per_turn,
                         next = std::size_t(0)]() mutable {
            std::vector<double> seconds(frame_parts, 0.0);
            for (int frame = 0; frame < frames_per_turn; ++frame)
                frames->add_frame(motion.steps[next++ % motion.steps.size()], seconds);
            for (double& sum : seconds) sum /= frames_per_turn;
            return seconds;
        });
    }
    std::vector<FrameTiming> timings;
    for (const Samples& seconds : take_turns(turns, rounds)) {
        const auto& [order, precision] = variants[timings.size()];
        FrameTiming& timing = timings.emplace_back(FrameTiming{name_of(order), name_of(precision)});
        const auto ms = [&](FramePart frame_part) { return scaled(spread_of(seconds[frame_part]), 1e3); };
        for (const RecordedPart& part : recorded_parts) timing.*part.ms = ms(part.sample);
        if (character.surface) {
            timing.surface_ms = ms(surface_s);
            timing.drawn_wall_ms = ms(drawn_wall_s);
        }
    }
    return timings;
}

const TableOneRow* table_1_row(const std::string& model)
{
    const auto row = std::ranges::find(table_1(), model, &TableOneRow::model);
    return row == table_1().end() ? nullptr : &*row;
}

using TimingRows = Columns<TimingRow>;
const TimingRows timing_columns =
    MEMBER_COLUMNS(TimingRow, mesh, body, model, stands_in, vertices, edges, tets, surface_vertices,
                   vertices_over_table_1, edges_over_table_1, tets_over_table_1) +
    within(&TimingRow::timing, frame_columns()) +
    MEMBER_COLUMNS(TimingRow, frames_per_s, drawn_frames_per_s, paper_frames_per_s, paper_ms, paper_ct_ms, cpu_model);

std::vector<TimingRow> timing_rows(const TimingRow& mesh, const std::vector<FrameTiming>& timings)
{
    std::vector<TimingRow> rows;
    for (const FrameTiming& timing : timings) {
        TimingRow& row = rows.emplace_back(mesh);
        row.timing = timing;
        row.frames_per_s = 1e3 / timing.total_wall_ms.median;
        if (timing.drawn_wall_ms) row.drawn_frames_per_s = 1e3 / timing.drawn_wall_ms->median;
        if (const TableOneRow* paper = table_1_row(mesh.model)) {
            row.vertices_over_table_1 = double(mesh.vertices) / paper->vertices;
            row.edges_over_table_1 = double(mesh.edges) / paper->stretch;
            row.tets_over_table_1 = double(mesh.tets) / paper->tets;
            row.paper_frames_per_s = paper->frames_per_s;
            row.paper_ms = 1e3 / paper->frames_per_s;
            row.paper_ct_ms = paper->total_ms / steps_in_1_s;
        }
    }
    return rows;
}

std::vector<analysis::Measurement> timing_measurements(const std::vector<TimingRow>& rows)
{
    std::vector<analysis::Measurement> measurements;
    for (const TimingRow& row : rows) {
        const FrameTiming& timing = row.timing;
        const bool is_judged = timing.variant == "plain" && timing.precision == "f64";
        if (row.paper_frames_per_s || (row.is_refined && is_judged))
            measurements.push_back(frame_rate(row, "frames_per_s", timing.total_wall_ms));
        if (!row.paper_frames_per_s) continue;
        if (is_judged) measurements.push_back(frame_rate(row, "frames_per_s_of_processor_time", timing.total_ms));
        for (const RecordedPart& part : recorded_parts)
            if (const Spread& ms = timing.*part.ms; part.is_value)
                measurements.push_back(measured(row, part.name, ms.median, ms.lower, ms.upper, "ms"));
    }
    std::ranges::move(timing_conclusions(measurements), std::back_inserter(measurements));
    return measurements;
}

std::vector<analysis::Measurement> timing_conclusions(const std::vector<analysis::Measurement>& measured)
{
    std::vector<analysis::Measurement> ratios;
    for (const analysis::Measurement& rate : measured) {
        const TableOneRow* paper = table_1_row(rate.of.model);
        if (!paper || rate.quantity != "frames_per_s" || rate.of.deformer != "pbs") continue;
        analysis::Measurement& ratio = ratios.emplace_back(rate);
        ratio.quantity = "frames_per_s_over_table_1";
        ratio.unit = "1";
        for (double* value : {&ratio.value, &ratio.low, &ratio.high}) *value /= paper->frames_per_s;
    }
    return ratios;
}

analysis::Measurement author_frame_rate(const TimingRow& mesh, const pbs::Character& character,
                                        const pbs::Motion& motion, const Rounds& rounds)
{
    const pbs::AuthorOptions options;
    pbs::AuthorSolver solver(character.mesh, character.skeleton, character.binding, options);
    std::size_t next = 0;
    const TimedVariant turn = [&] {
        const pbs::Stopwatch wall;
        for (int frame = 0; frame < usual_frames_per_turn; ++frame)
            solver.advance(motion.steps[next++ % motion.steps.size()]);
        return std::vector<double>{1e3 * wall.seconds() / usual_frames_per_turn};
    };
    analysis::Measurement rate = frame_rate(mesh, "frames_per_s", spread_of(take_turns({turn}, rounds)[0][0]));
    rate.of.deformer = "pbs_author";
    rate.of.order = "first_fit";
    rate.of.precision = "f64";
    rate.of.iterations = options.iterations;
    return rate;
}

analysis::CsvTable real_time_ends(const analysis::CsvTable& timings)
{
    analysis::CsvTable ends({"variant", "precision", "vertices", "is_beyond", "exponent"}, "real_time.csv");
    for (const auto& [order, precision] :
         {std::pair("plain", "f64"), std::pair("plain", "f32"), std::pair("ordered", "f32")}) {
        const analysis::CsvTable ladder = timings.where({{"model", ""}, {"variant", order}, {"precision", precision}});
        if (ladder.rows() < 2) continue;
        const analysis::PowerLawEnd end =
            analysis::power_law_end(ladder.numbers("vertices"), ladder.numbers("total_wall_ms"), 1e3 / 30.0);
        ends.add_row({order, precision, end.size, end.beyond, end.exponent});
    }
    return ends;
}

std::string measure_frames(const TimedCase& timed_case, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(timed_case.scene.character);
    const pbs::Motion motion = make_motion(timed_case.scene.motion, character.skeleton, timed_case.scene.file);
    TimingRow mesh{.mesh = timed_case.name,
                   .body = timed_case.scene.character.body,
                   .model = timed_case.model,
                   .stands_in = timed_case.stands_in};
    mesh.is_refined = timed_case.scene.character.refinements > 0;
    mesh.vertices = static_cast<int>(character.mesh.rest.rows());
    mesh.edges = static_cast<int>(pbs::edges_of(character.mesh.tets).rows());
    mesh.tets = static_cast<int>(character.mesh.tets.rows());
    mesh.cpu_model = analysis::collect_provenance(1).cpu_model;
    mesh.surface_vertices = character.surface ? static_cast<int>(character.surface->tet.size()) : 0;
    // So many rounds that they take about these seconds of one core, whatever else the machine does. A round is two
    // frames of three variants, each timed twice.
    const int count = std::clamp(static_cast<int>(timed_case.seconds / (round_s_per_vertex * mesh.vertices)),
                                 timed_case.fewest_rounds, most_rounds);
    const Rounds rounds = {.seconds = 0.0, .fewest = count, .most = count};
    const auto rows = timing_rows(mesh, time_frames(character, motion, timed_case.k_jiggle, rounds));
    table_of(timing_columns, rows).write(analysis::path_in(folder, "timing.csv"));
    auto measured = timing_measurements(rows);
    if (!timed_case.model.empty()) measured.push_back(author_frame_rate(mesh, character, motion, rounds));
    if (!measured.empty()) analysis::measurement_table(measured).write(analysis::path_in(folder, "measurements.csv"));
    return "";
}

RECORD_SETTINGS_AND(TimedCase,
                    .derived("refinements",
                             [](const TimedCase& timed_case) { return timed_case.scene.character.refinements; })
                        .constant("iterations", paper_iterations)
                        .constant("frames_a_turn", usual_frames_per_turn)
                        .constant("round_s_a_vertex", round_s_per_vertex)
                        .constant("most_rounds", most_rounds)
                        .constant("cpu_model", analysis::collect_provenance(1).cpu_model),
                    name, scene, model, stands_in, k_jiggle, seconds, fewest_rounds)

}  // namespace experiments
