// A character from 2,000 to 1,000,000 tets: the time of mesh, set-up, LBS and PBS, metrics and frames on disk, the peak memory, and how
// they grow.
//
//   human  MakeHuman's body, 6 frames of the clip's jump, at 600 to 20,000 vertices (--full: to 190,000)
//
// The sizes run one after the other, each in a process of its own with an empty cache of meshes. Writes DIR/scale/sizes/VERTICES/... (a
// run's folder), DIR/scale/scale.csv and scale.md.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "analysis/statistics/fits.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/scale/scale_records.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <filesystem>

namespace experiments {
namespace {

using Rows = analysis::Columns<ScaleRow>;

Scene human_of(int vertices)
{
    return read_scene("human_01_01", {"character.vertices=" + std::to_string(vertices), "motion.start_s=1.6", "motion.duration_s=0.05",
                                      R"(deformers.use=["lbs", "pbs"])", R"(reference.name="")", "output.frames_every=1",
                                      "output.frames=[]", "output.frame_names=[]"});
}

std::string run_sizes(const ScaleCase& of, const std::string& folder)
{
    const std::string cache = analysis::path_in(folder, "cache");
    std::vector<ScaleRow> rows;
    std::string failures;
    for (const int vertices : of.vertices) {
        const std::string run_folder = analysis::path_in(folder, std::to_string(vertices));
        std::filesystem::remove_all(cache);
        const nlohmann::json run = run_scene_alone(human_of(vertices), run_folder, [&] { setenv("PBSKIN_CACHE", cache.c_str(), 1); });
        const nlohmann::json& outcome = run.at("outcome");
        for (const char* failure : {"breakdown", "bad_frame"})
            if (const std::string words = outcome.at(failure); !words.empty()) failures += fmt::format("{} vertices: {} ", vertices, words);
        rows.push_back(scale_row(run, analysis::read_csv(analysis::path_in(run_folder, "metrics.csv"))));
        spdlog::info("{} tets: {:.3g} ms per step, {:.3g} s in all", rows.back().tets, rows.back().step_ms, rows.back().total_s);
    }
    std::filesystem::remove_all(cache);
    table_of(scale_columns, rows).write(analysis::path_in(folder, "scale.csv"));
    return failures;
}

StudyPlan plan(bool full)
{
    ScaleCase of{{600, 2400, 7000, 20000}};
    if (full) of.vertices.insert(of.vertices.end(), {60000, 190000});
    StudyPlan plan;
    try {
        plan.runs.push_back(work_run("sizes", of, full ? 500.0 : 60.0, run_sizes));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"scale: nothing ran\n", false};
    const analysis::CsvTable table = table_of(scale_columns, finished.rows(scale_columns, "scale.csv"));
    finished.write("scale.csv", table);
    const std::string text = scale_markdown(table);
    finished.write("scale.md", text);
    return {text, true};
}

}  // namespace

const Rows scale_columns = {{"vertices", &ScaleRow::vertices, "", "vertices of the mesh"},
                            {"edges", &ScaleRow::edges, "", "edges of the mesh"},
                            {"tets", &ScaleRow::tets, "", "tets of the mesh"},
                            {"constraints", &ScaleRow::constraints, "", "bind, stretch and volume constraints"},
                            {"iterations", &ScaleRow::iterations, "", "iterations per step"},
                            {"frames", &ScaleRow::frames, "", "frames of the motion"},
                            {"step_ms", &ScaleRow::step_ms, "ms", "a step of PBS, mean over the frames"},
                            {"ns_a_constraint", &ScaleRow::ns_per_constraint, "ns", "the same per constraint and iteration"},
                            {"character_s", &ScaleRow::character_s, "s", "mesh, weights and surface"},
                            {"set_up_s", &ScaleRow::set_up_s, "s", "set-up of the deformers"},
                            {"metrics_set_up_s", &ScaleRow::metrics_set_up_s, "s", "set-up of the metrics"},
                            {"metrics_ms", &ScaleRow::metrics_ms, "ms", "metrics, per frame and deformer"},
                            {"write_ms", &ScaleRow::write_ms, "ms", "a frame on disk, per deformer"},
                            {"records_s", &ScaleRow::records_s, "s", "records of the run"},
                            {"total_s", &ScaleRow::total_s, "s", "the whole run"},
                            {"peak_mb", &ScaleRow::peak_mb, "MB", "peak memory, 10^6 bytes"}};

nlohmann::json to_json(const ScaleCase& of)
{
    static const auto fields = OptionFields<ScaleCase>("scale")
                                   .record("vertices", &ScaleCase::vertices)
                                   .derived("scene", [](const ScaleCase& of) { return to_json(human_of(of.vertices.front())); })
                                   .complete();
    return fields.json(of);
}

ScaleRow scale_row(const nlohmann::json& run, const analysis::CsvTable& metrics)
{
    ScaleRow row;
    const nlohmann::json &character = run.at("character"), &seconds = run.at("cost").at("cpu_seconds");
    row.vertices = character.at("vertices");
    row.edges = character.at("quality").at("edges");
    row.tets = character.at("tets");
    row.constraints = static_cast<double>(row.vertices + row.edges + row.tets);
    row.frames = run.at("outcome").at("frames");
    for (int i = 0; i < metrics.rows(); ++i)
        if (metrics.text_at(i, "deformer") == "pbs") row.iterations = static_cast<int>(metrics.integer(i, "iterations"));
    row.step_ms = 1e3 * seconds.at("deformers").at("pbs").at("step").get<double>() / row.frames;
    row.ns_per_constraint = 1e6 * row.step_ms / (row.constraints * row.iterations);
    row.character_s = seconds.at("character");
    row.set_up_s = seconds.at("set_up");
    row.metrics_set_up_s = seconds.at("metrics_set_up");
    row.records_s = seconds.at("records");
    row.total_s = seconds.at("total");
    row.metrics_ms = 1e3 * seconds.at("metrics").get<double>() / metrics.rows();
    row.write_ms = 1e3 * seconds.at("frames").get<double>() / metrics.rows();
    row.peak_mb = run.at("cost").at("peak_memory_mb");
    return row;
}

std::string scale_markdown(const analysis::CsvTable& table)
{
    std::string text =
        markdown_table(table, analysis::report_columns("tets constraints:.0f step_ms:.3g ns_a_constraint:.2f character_s:.3g set_up_s:.3g "
                                                       "metrics_set_up_s:.3g metrics_ms:.3g write_ms:.3g total_s:.3g frames peak_mb:.0f"));
    if (table.rows() < 2) return text;
    text += "\n| cost | grows with constraints^p, p [95 %] |\n|---|---|\n";
    for (const char* cost : {"step_ms", "character_s", "set_up_s", "metrics_ms", "write_ms", "peak_mb"}) {
        const analysis::Interval p = analysis::observed_order(table.numbers("constraints"), table.numbers(cost)).slope;
        text += fmt::format("| {} | {:.2f} [{:.2f}, {:.2f}] |\n", scale_columns.named(cost).meaning, p.estimate, p.low, p.high);
    }
    return text;
}

Study scale_study()
{
    return {"scale", plan, when_named, conclude, true};
}

}  // namespace experiments
