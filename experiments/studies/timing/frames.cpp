#include "experiments/studies/timing/frames.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "analysis/statistics/fits.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/projection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace experiments {
namespace {

enum FramePart { lbs_s, bind_s, stretch_s, volume_s, rest_s, total_s, total_wall_s, surface_s, drawn_wall_s, frame_parts };

constexpr std::pair<pbs::Order, pbs::Precision> variants[] = {
    {pbs::Order::plain, pbs::Precision::f64}, {pbs::Order::plain, pbs::Precision::f32}, {pbs::Order::ordered, pbs::Precision::f32}};

pbs::PbsOptions without_iterations(pbs::PbsOptions options)
{
    options.iterations = 0;
    return options;
}

// One variant on its way through the motion.
template <typename Scalar>
class VariantFrames {
public:
    VariantFrames(const pbs::Character& character, const pbs::PbsOptions& options)
        : character_(character),
          zone_(pbs::jiggle_zone(character.binding)),
          skinning_(character.mesh.rest, character.weights),
          solver_(character.mesh, character.binding.distance, zone_, options),
          idle_solver_(character.mesh, character.binding.distance, zone_, without_iterations(options)),
          projection_(pbs::make_projection(pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, zone_, options),
                                           character.mesh.tets, options))
    {
    }

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
            seconds[surface_s] +=
                cpu_seconds([&] { surface_ = pbs::embedded_positions(*character_.surface, solver_.positions(), character_.mesh.tets); });
            seconds[drawn_wall_s] += wall.seconds();
        }
        seconds[rest_s] += cpu_seconds([&] { idle_solver_.advance(lbs_, bind_points(), time_step_s); });

        // Each class by itself, which is for timing alone, from the frame's LBS.
        using Projection = pbs::Projection<Scalar>;
        projection_->load(lbs_, bind_points(), pbs::Vec3::Zero());
        for (const auto& [sample, project] :
             {std::pair(volume_s, &Projection::project_volume_constraints), std::pair(stretch_s, &Projection::project_stretch_constraints),
              std::pair(bind_s, &Projection::project_bind_constraints)})
            seconds[sample] += cpu_seconds([&, project = project] {
                for (int iteration = 0; iteration < timed_iterations; ++iteration) (projection_.get()->*project)();
            });
    }

private:
    const pbs::Character& character_;
    std::vector<bool> zone_;
    pbs::BlendSkinning<double> skinning_;
    pbs::PbsSolver solver_, idle_solver_;
    std::unique_ptr<pbs::Projection<Scalar>> projection_;
    pbs::Positions lbs_, surface_;
};

template <typename Scalar>
TimedVariant turns_of(const pbs::Character& character, const pbs::Motion& motion, const pbs::PbsOptions& options, int frames_per_turn)
{
    const auto frames = std::make_shared<VariantFrames<Scalar>>(character, options);
    return [frames, &motion, frames_per_turn, next = std::size_t(0)]() mutable {
        std::vector<double> seconds(frame_parts, 0.0);
        for (int frame = 0; frame < frames_per_turn; ++frame) frames->add_frame(motion.steps[next++ % motion.steps.size()], seconds);
        for (double& sum : seconds) sum /= frames_per_turn;
        return seconds;
    };
}

FrameTiming summed_up(pbs::Order order, pbs::Precision precision, const Samples& seconds, bool has_surface)
{
    const auto ms = [&](FramePart of) { return scaled(spread_of(seconds[of]), 1e3); };
    FrameTiming timing{name_of(order), name_of(precision), ms(lbs_s),   ms(bind_s),      ms(stretch_s),
                       ms(volume_s),   ms(rest_s),         ms(total_s), ms(total_wall_s)};
    if (has_surface) timing.surface_ms = ms(surface_s), timing.drawn_wall_ms = ms(drawn_wall_s);
    return timing;
}

}  // namespace

std::vector<FrameTiming> time_frames(const pbs::Character& character, const pbs::Motion& motion, const TimedFrames& timed,
                                     const Rounds& rounds)
{
    std::vector<TimedVariant> turns;
    for (const auto& [order, precision] : variants) {
        pbs::PbsOptions options;
        options.iterations = timed_iterations;
        options.order = order;
        options.precision = precision;
        options.gravity_m_s2 = {0.0, -9.81, 0.0};
        options.jiggle = pbs::Jiggle{timed.k_jiggle};
        turns.push_back(precision == pbs::Precision::f32 ? turns_of<float>(character, motion, options, timed.frames_per_turn)
                                                         : turns_of<double>(character, motion, options, timed.frames_per_turn));
    }
    const std::vector<Samples> seconds = take_turns(turns, rounds);
    std::vector<FrameTiming> timings;
    for (std::size_t i = 0; i < turns.size(); ++i)
        timings.push_back(summed_up(variants[i].first, variants[i].second, seconds[i], character.surface.has_value()));
    return timings;
}

namespace {

using analysis::Columns;
using analysis::within;

constexpr double steps_in_1_s = 100.0;

using Mesh = Columns<TimedMesh>;
const Mesh mesh_columns = {{"mesh", &TimedMesh::name, "", "name of the mesh"},
                           {"body", &TimedMesh::body, "", "name of the body"},
                           {"model", &TimedMesh::model, "", "row of Table 1 that it is made to; empty: a step of the ladder of sizes"},
                           {"stands_in", &TimedMesh::stands_in, "", "the body is not the one that the model names"},
                           {"vertices", &TimedMesh::vertices, "", "vertices of the tet mesh"},
                           {"edges", &TimedMesh::edges, "", "edges of the tet mesh"},
                           {"tets", &TimedMesh::tets, "", "tets of the mesh"},
                           {"surface_vertices", &TimedMesh::surface_vertices, "", "vertices of the embedded surface"}};
const Mesh machine_columns = {{"cpu_model", &TimedMesh::cpu_model, "", "the processor"}};

using Frame = Columns<FrameTiming>;
Frame spread(Spread FrameTiming::*part, const char* name, const char* meaning)
{
    return within(part, spread_columns(name, "ms", meaning));
}
const Frame frame_columns = Frame{{"variant", &FrameTiming::variant, "", "plain or ordered"},
                                  {"precision", &FrameTiming::precision, "", "f32 or f64"},
                                  {"rounds", [](auto& timing) -> decltype(auto) { return (timing.total_ms.rounds); }, "", "timed rounds"}} +
                            spread(&FrameTiming::lbs_ms, "lbs_ms", "LBS, processor time") +
                            spread(&FrameTiming::bind_ms, "bind_ms", "bind constraints, 24 iterations, processor time") +
                            spread(&FrameTiming::stretch_ms, "stretch_ms", "stretch constraints, 24 iterations, processor time") +
                            spread(&FrameTiming::volume_ms, "volume_ms", "volume constraints, 24 iterations, processor time") +
                            spread(&FrameTiming::rest_ms, "rest_ms", "a step without iterations, processor time") +
                            spread(&FrameTiming::total_ms, "total_ms", "the whole frame, processor time") +
                            spread(&FrameTiming::total_wall_ms, "total_wall_ms", "the whole frame, wall time") +
                            within(&FrameTiming::surface_ms, spread_columns("surface_ms", "ms", "the embedded surface, processor time")) +
                            within(&FrameTiming::drawn_wall_ms, spread_columns("drawn_wall_ms", "ms", "frame and surface, wall time"));

const TableOneRow* row_of(const std::string& model)
{
    const auto row = std::find_if(table_1().begin(), table_1().end(), [&](const TableOneRow& one) { return one.model == model; });
    return row == table_1().end() ? nullptr : &*row;
}

analysis::Measurement measured(const TimingRow& row, const std::string& quantity, double value, double low, double high,
                               const std::string& unit)
{
    const analysis::CaseKey of = {.body = row.mesh.body,
                                  .motion = "01_01",
                                  .deformer = "pbs",
                                  .order = row.timing.variant,
                                  .precision = row.timing.precision,
                                  .vertices = row.mesh.vertices,
                                  .model = row.mesh.model};
    return {"C10", quantity, of, value, low, high, unit};
}

// Frames per second over `baseline`.
analysis::Measurement frame_rate(const TimingRow& row, const std::string& quantity, const Spread& ms, double baseline = 1.0,
                                 const std::string& unit = "1/s")
{
    return measured(row, quantity, 1e3 / ms.median / baseline, 1e3 / ms.upper / baseline, 1e3 / ms.lower / baseline, unit);
}

}  // namespace

using TimingRows = Columns<TimingRow>;
const TimingRows timing_columns =
    within(&TimingRow::mesh, mesh_columns) +
    TimingRows{{"vertices_over_table_1", &TimingRow::vertices_over_table_1, "", "vertices over those of the model"},
               {"edges_over_table_1", &TimingRow::edges_over_table_1, "", "edges over the model's stretch constraints"},
               {"tets_over_table_1", &TimingRow::tets_over_table_1, "", "tets over those of the model"}} +
    within(&TimingRow::timing, frame_columns) +
    TimingRows{{"frames_per_s", &TimingRow::frames_per_s, "1/s", "frame rate by wall time"},
               {"drawn_frames_per_s", &TimingRow::drawn_frames_per_s, "1/s", "frame rate by wall time, with the surface"},
               {"paper_frames_per_s", &TimingRow::paper_frames_per_s, "1/s", "frame rate in Table 1"},
               {"paper_ms", &TimingRow::paper_ms, "ms", "time per frame by that frame rate"},
               {"paper_ct_ms", &TimingRow::paper_ct_ms, "ms", "time per step by the CT total of Table 1, which is of 100 steps"}} +
    within(&TimingRow::mesh, machine_columns);

std::vector<TimingRow> timing_rows(const TimedMesh& mesh, const std::vector<FrameTiming>& timings)
{
    std::vector<TimingRow> rows;
    for (const FrameTiming& timing : timings) {
        TimingRow row{.mesh = mesh, .timing = timing, .frames_per_s = 1e3 / timing.total_wall_ms.median};
        if (timing.drawn_wall_ms) row.drawn_frames_per_s = 1e3 / timing.drawn_wall_ms->median;
        if (const TableOneRow* paper = row_of(mesh.model)) {
            row.vertices_over_table_1 = double(mesh.vertices) / paper->vertices;
            row.edges_over_table_1 = double(mesh.edges) / paper->stretch;
            row.tets_over_table_1 = double(mesh.tets) / paper->tets;
            row.paper_frames_per_s = paper->frames_per_s;
            row.paper_ms = 1e3 / paper->frames_per_s;
            row.paper_ct_ms = paper->total_ms / steps_in_1_s;
        }
        rows.push_back(row);
    }
    return rows;
}

std::vector<analysis::Measurement> timing_measurements(const std::vector<TimingRow>& rows)
{
    std::vector<analysis::Measurement> all;
    for (const TimingRow& row : rows) {
        if (!row.paper_frames_per_s) continue;
        const FrameTiming& timing = row.timing;
        all.push_back(frame_rate(row, "frames_per_s", timing.total_wall_ms));
        if (timing.variant == "plain" && timing.precision == "f64")  // the variant that is judged
            all.push_back(frame_rate(row, "frames_per_s_of_processor_time", timing.total_ms));
        all.push_back(frame_rate(row, "frames_per_s_over_table_1", timing.total_wall_ms, *row.paper_frames_per_s, "1"));
        for (const auto& [quantity, ms] :
             {std::pair("lbs_ms", &timing.lbs_ms), std::pair("bind_ms", &timing.bind_ms), std::pair("stretch_ms", &timing.stretch_ms),
              std::pair("volume_ms", &timing.volume_ms), std::pair("total_ms", &timing.total_ms)})
            all.push_back(measured(row, quantity, ms->median, ms->lower, ms->upper, "ms"));
    }
    return all;
}

namespace {

const std::string short_columns =
    "body vertices variant precision lbs_ms:.3f bind_ms:.3f stretch_ms:.3f volume_ms:.3f total_wall_ms:.3g frames_per_s:.0f "
    "drawn_frames_per_s:.0f paper_frames_per_s:.1f";
const std::string all_columns =
    short_columns +
    " total_wall_ms_low:.3g total_wall_ms_high:.3g total_ms:.3g rest_ms:.3g surface_ms:.3g paper_ms:.2f paper_ct_ms:.2f model "
    "vertices_over_table_1:.2f edges_over_table_1:.2f tets_over_table_1:.2f";

std::string machines(const std::vector<TimingRow>& rows)
{
    std::set<std::string> names;
    for (const TimingRow& row : rows) names.insert(row.mesh.cpu_model);
    return fmt::format("{}", fmt::join(names, "; "));
}

std::string ends_text(const std::vector<TimingRow>& rows)
{
    std::string text;
    for (const auto& [variant, precision] : {std::pair("plain", "f64"), std::pair("plain", "f32"), std::pair("ordered", "f32")}) {
        std::vector<double> vertices, total_ms;
        for (const TimingRow& row : rows)
            if (row.mesh.model.empty() && row.timing.variant == variant && row.timing.precision == precision) {
                vertices.push_back(row.mesh.vertices);
                total_ms.push_back(row.timing.total_wall_ms.median);
            }
        if (vertices.size() < 2) continue;
        const analysis::PowerLawEnd end = analysis::power_law_end(vertices, total_ms, 1e3 / 30.0);
        text += fmt::format("  {:<8} {}: 30 frames per second up to {:.3g} vertices{}; ms per frame ~ vertices^{:.2f}\n", variant,
                            precision, end.size, end.beyond ? " (beyond the measured sizes)" : "", end.exponent);
    }
    return text;
}

}  // namespace

std::string timing_markdown(const std::vector<TimingRow>& rows)
{
    return fmt::format("Timed on {}. Times are per frame.\n\n{}\n```\n{}```\n", machines(rows),
                       markdown_table(table_of(timing_columns, rows), analysis::report_columns(all_columns)), ends_text(rows));
}

std::string timing_text(const std::vector<TimingRow>& rows)
{
    const std::string table = text_table(table_of(timing_columns, rows), analysis::report_columns(short_columns));
    return fmt::format("Per frame, on one core of {}:\n{}{}", machines(rows), table, ends_text(rows));
}

namespace {

constexpr double round_s_per_vertex = 24e-6;
constexpr int fewest_rounds = 3, most_rounds = 61;

// So many rounds that they take about `seconds` of one core, whatever else the machine does. A round is two frames of three variants, each
// timed twice.
Rounds rounds_for(int vertices, double seconds)
{
    const int rounds = std::clamp(static_cast<int>(seconds / (round_s_per_vertex * vertices)), fewest_rounds, most_rounds);
    return {.seconds = 0.0, .fewest = rounds, .most = rounds};
}

}  // namespace

std::string measure_frames(const TimedCase& of, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const pbs::Motion motion = make_motion(of.scene.motion, character.skeleton, of.scene.file);
    TimedMesh mesh{.name = of.name(), .body = of.scene.character.body, .model = of.model, .stands_in = of.stands_in};
    mesh.vertices = static_cast<int>(character.mesh.rest.rows());
    mesh.edges = static_cast<int>(pbs::edges_of(character.mesh.tets).rows());
    mesh.tets = static_cast<int>(character.mesh.tets.rows());
    mesh.cpu_model = analysis::collect_provenance(1).cpu_model;
    mesh.surface_vertices = character.surface ? static_cast<int>(character.surface->tet.size()) : 0;
    const auto rows = timing_rows(mesh, time_frames(character, motion, {.k_jiggle = of.k_jiggle}, rounds_for(mesh.vertices, of.seconds)));
    table_of(timing_columns, rows).write(analysis::path_in(folder, "timing.csv"));
    const auto measured = timing_measurements(rows);
    if (!measured.empty()) analysis::measurement_table(measured).write(analysis::path_in(folder, "measurements.csv"));
    return "";
}

std::string TimedCase::name() const
{
    const pbs::CharacterSource& character = scene.character;
    const std::string name = fmt::format("{}_{}", character.body, character.vertices);
    return character.refinements ? fmt::format("{}_refined_{}", name, character.refinements) : name;
}

nlohmann::json to_json(const TimedCase& of)
{
    static const auto fields = OptionFields<TimedCase>("timing")
                                   .record("scene", &TimedCase::scene)
                                   .derived("refinements", [](const TimedCase& of) { return of.scene.character.refinements; })
                                   .record("model", &TimedCase::model)
                                   .record("stands_in", &TimedCase::stands_in)
                                   .record("k_jiggle", &TimedCase::k_jiggle)
                                   .record("seconds", &TimedCase::seconds)
                                   .constant("iterations", timed_iterations)
                                   .constant("frames_a_turn", TimedFrames{}.frames_per_turn)
                                   .constant("round_s_a_vertex", round_s_per_vertex)
                                   .constant("rounds", {fewest_rounds, most_rounds})
                                   .constant("cpu_model", analysis::collect_provenance(1).cpu_model)
                                   .complete();
    return fields.json(of);
}

}  // namespace experiments
