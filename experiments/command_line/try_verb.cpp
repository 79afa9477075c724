// pbskin try MODEL [--animation NAME] [-o DIR]: a rigged model through its own motion, without a scene: runs it with
// all methods, and writes a summary, the scene to go on with, and a page with the moving model.

#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/run.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/trial/bake.hpp"
#include "experiments/trial/trial.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/child_process.hpp"
#include "pbs/system/source_file.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <optional>
#include <utility>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// In a build as in an installation, share/pbskin is next to the folder of the program.
fs::path page_maker()
{
    return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share/pbskin/paper_figures/make_report.py";
}

constexpr double most_glb_bytes = 33e6,
                 most_skin_bytes = 12e6;  // with the page and the tables, a trial takes at most 60 MB

// Runs the scene that was just written. If the run fails, the folder keeps the results of an earlier trial and their
// scene.
RunResult run_new_scene(const std::string& scene_file, const std::string& earlier_scene, const TrialOptions& options,
                        bool folder_is_new, int threads, const Remarks& remarks, std::optional<pbs::SourceFile> model)
{
    try {
        Scene scene = read_scene(scene_file, {});
        for (DeformerSpec& spec : scene.deformers) spec.threads = threads;
        scene.output.surface_files = options.paraview;
        if (!options.paraview) {
            scene.output.most_glb_bytes = most_glb_bytes;
            scene.output.most_skin_bytes = most_skin_bytes;
        }
        return run_scene(scene, options.folder, remarks, WhenInterrupted::finish_early, std::move(model));
    } catch (...) {
        std::error_code code;
        if (!earlier_scene.empty())
            analysis::write_text_atomically(scene_file, earlier_scene);
        else if (!fs::exists(fs::path(options.folder) / "frames", code))
            fs::remove(scene_file, code);
        if (folder_is_new) fs::remove(options.folder, code);  // fails if anything else is there
        throw;
    }
}

// Exit statuses of make_report.py. With --needs-model, 3 means that it has written the page without the moving model.
constexpr int page_without_model = 3;
constexpr int python_without_packages = 4;  // numpy or matplotlib cannot be imported

// Writes `folder`/report.html by the scripts of paper_figures. The page maker runs as a process of its own, which
// reports what is missing. Returns its exit status. InputErrors: no such folder, no python3 with the packages that
// draw, no page maker.
int write_report_page(const std::string& folder, bool quiet, bool needs_model)
{
    if (!fs::is_directory(folder))
        throw pbs::InputError(folder, 0, "", "",
                              "no such folder: expected one that `pbskin try`, `run` or `reproduce` wrote");
    if (!analysis::is_utf8(folder))
        throw pbs::InputError(folder, 0, "", "",
                              "expected a name in UTF-8: the libraries that draw the page open no others");
    if (!fs::is_regular_file(page_maker()))
        throw pbs::InputError(page_maker().string(), 0, "", "",
                              "not found: the page is made by scripts that are installed with the program");
    const pbs::Stage stage("making the page " + (fs::path(folder) / "report.html").string());
    std::vector<std::string> words = {"", "-E", "-s", "-B", page_maker().string(), folder};
    if (quiet) words.push_back("--quiet");
    if (needs_model) words.push_back("--needs-model");
    // Modules of other environments are not imported: -E ignores PYTHONPATH and PYTHONHOME, -s the packages of the
    // user. (-I would also hide the modules of the page maker itself.) Debian's python3 comes first, for one of a
    // version manager on the PATH often lacks the packages that the figures need.
    for (const char* python : {"/usr/bin/python3", "python3"}) {
        words.front() = python;
        const ProgramRun page = run_program(words, std::nullopt);
        if (page.started && page.status != python_without_packages)
            return page.status >= 0 ? page.status : 128 - page.status;
    }
    throw pbs::InputError(
        "", 0, "report", "",
        "no python3 that can import numpy and matplotlib: install python3-numpy and python3-matplotlib");
}

// A trial leaves the page, the tables, the .glb files and the artist's surface. The frames for ParaView take most of
// the space; once the page has a viewer, it has what it shows of them.
void leave_what_is_of_use(const TrialOptions& options, int page)
{
    const fs::path folder = options.folder;
    const bool leaves_out = page == exit_finished && !options.paraview;
    if (leaves_out) remove_frames(options.folder);
    if (page == page_without_model)
        warn(
            {fmt::format("{}/report.html: the page has no viewer, for the reason above; the frames remain, so that "
                         "`pbskin report {}` "
                         "can add it once that reason is gone",
                         options.folder, options.folder)});
    std::uintmax_t bytes = 0;
    int files = 0;
    for (const auto& file : fs::recursive_directory_iterator(folder)) {
        if (!file.is_regular_file()) continue;
        bytes += file.file_size();
        ++files;
    }
    spdlog::info("{}: {:.1f} MB in {} files{}", options.folder, static_cast<double>(bytes) / 1e6, files,
                 leaves_out ? ", without frames for ParaView (--paraview keeps them)" : "");
}

int try_model(TrialOptions options, const CommonOptions& common)
{
    std::optional<pbs::SourceFile> model(options.model);  // keeps the bytes until the run has read them
    if (options.folder.empty()) options.folder = "results/" + fs::path(options.model).stem().string();
    const TrialScene made = [&] {
        const pbs::Stage stage("reading " + options.model);
        return trial_scene(options);
    }();
    const bool is_new = analysis::make_output_folder(options.folder);
    const std::string scene_file = (fs::path(options.folder) / "scene.toml").string(),
                      earlier_scene = earlier_trial_scene(options);
    analysis::write_text_atomically(scene_file, made.text);

    const RunResult result =
        run_new_scene(scene_file, earlier_scene, options, is_new, common.threads, made.remarks, std::move(model));
    analysis::remove_record(fs::path(options.folder) / "frames" / "correctives.toml");  // of an earlier trial
    for (const auto& line : result.lines) spdlog::info("{}", line);
    nlohmann::json facts = trial_facts(options.folder);
    facts["animations"] = made.animations;
    facts["summary"] = trial_sentence(facts);
    facts["nearest_sentence"] = nearest_sentence(facts);
    const auto write_facts = [&] {
        analysis::write_text_atomically((fs::path(options.folder) / "try.json").string(), analysis::record_text(facts));
    };
    write_facts();  // also for a bake that fails
    if (options.bake && !result.was_interrupted) {
        BakeOptions bake{.surface_files = options.paraview};
        if (options.reference_seconds > 0.0) bake.seconds = options.reference_seconds;
        if (!options.paraview) bake.most_glb_bytes = most_glb_bytes;
        facts["correctives"] = bake_correctives(read_scene(scene_file, {}), options.folder, bake);
        write_facts();
        spdlog::info("{}", bake_sentence(facts["correctives"], options.folder));
    }
    const int written = write_report_page(options.folder, common.quiet, true);
    const int page = written == page_without_model ? exit_finished : written;
    leave_what_is_of_use(options, written);
    spdlog::info("{}", facts["summary"].get<std::string>());
    if (result.was_interrupted) {
        spdlog::error("pbskin: interrupted; {} has what was finished, and the same command goes on from there",
                      page == exit_finished ? options.folder + "/report.html" : options.folder);
        return exit_interrupted;
    }
    if (page == exit_finished)
        say_next(fmt::format("xdg-open {}/report.html, or change {} and pbskin run it", options.folder, scene_file));
    if (result.failure().empty()) return page;
    spdlog::error("pbskin: {}", result.failure());
    return exit_breakdown;
}

}  // namespace

// pbskin report DIR: writes the records and the figures drawn from them as one self-contained page, DIR/report.html.
void add_report_verb(CommandLine& line)
{
    auto folder = std::make_shared<std::string>();
    CLI::App* verb = line.add("report", "writes records and figures on one HTML page that loads nothing",
                              "pbskin report results/reproduce", [&common = line.common, folder] {
                                  const int status = write_report_page(*folder, common.quiet, false);
                                  if (status == exit_finished) say_next("xdg-open " + *folder + "/report.html");
                                  return status;
                              });
    verb->add_option("folder", *folder, "the folder that reproduce, run or try wrote; the page is report.html in it")
        ->required();
}

void add_try_verb(CommandLine& line)
{
    auto options = std::make_shared<TrialOptions>();
    CLI::App* verb = line.add("try", "runs a rigged model through its own motion and writes a page",
                              "pbskin try hero.glb, then xdg-open results/hero/report.html",
                              [&common = line.common, options] { return try_model(*options, common); });
    verb->add_option("model", options->model, ".glb .gltf .fbx .dae .zae")->required();
    verb->add_option(
        "--animation", options->animation,
        "an animation of the model by name, the second of equal names being NAME (2), or a clip FILE (.bvh .gltf .glb "
        ".fbx .dae .zae), or "
        "an animation of one, FILE:NAME; by default the model's first one that turns a joint by more than 5 degrees");
    verb->add_option(
        "-o,--output", options->folder,
        "folder of the records; by default results/NAME; an earlier trial of the same model there is replaced");
    verb->add_option("--frames", options->frames, "largest number of frames, distributed over the motion")
        ->check(CLI::Range(2, 100'000))
        ->capture_default_str();
    verb->add_option("--vertices", options->vertices, "wanted number of vertices of the tets; by default 2000")
        ->check(CLI::Range(150, 10'000'000));
    verb->add_option("--skeleton", options->skeleton, "skeleton of a model without joints: a file, or human");
    verb->add_option("--scale", options->scale, "enlarges the model, for files that state a wrong unit");
    verb->add_flag("--paraview", options->paraview,
                   "also keeps the frames for ParaView (.vtu, .vtp): most of the space");
    verb->add_flag(
        "--allow-partial", options->allow_partial,
        "accepts a clip of which fewer than half of the moving joints match a bone, or one half of a limb alone does");
    auto* bake = verb->add_flag("--bake", options->bake,
                                "learns shapes of the reference, as correctives for scenes and engines");
    auto* error_bar =
        verb->add_flag("--error-bar", options->error_bar,
                       "also bounds the reference's own error, by three further solutions per frame, two of them on "
                       "tets cut into eight. With 2,000 "
                       "vertices each frame takes minutes, and the run needs 6 GB: choose a few --frames");
    auto* seconds = verb->add_option("--reference-seconds", options->reference_seconds,
                                     "processor time of the finite elements; 0: no limit")
                        ->check(CLI::Range(0.0, 1e7))
                        ->capture_default_str()
                        ->excludes(error_bar);
    verb->add_flag_callback(
            "--no-reference", [options] { options->reference = false; },
            "leaves out the finite elements, which take most of the time")
        ->excludes(error_bar)
        ->excludes(seconds)
        ->excludes(bake);
}

}  // namespace experiments
