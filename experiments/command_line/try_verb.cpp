// pbskin try MODEL [--animation NAME] [-o DIR]: a rigged model through its own motion, without a scene: runs it with all methods, and
// writes a summary, the scene to go on with, and a page with the moving model.

#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/run.hpp"
#include "experiments/trial/trial.hpp"
#include "pbs/character/body_cache.hpp"
#include "pbs/character/json_file.hpp"
#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// In a build as in an installation, share/pbskin is next to the folder of the program.
fs::path page_maker()
{
    return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share/pbskin/paper_figures/make_report.py";
}

// Debian's python3 comes first, for one of a version manager on the PATH often lacks the packages that the figures need.
std::string python_that_draws()
{
    const analysis::ScratchFolder scratch;
    for (const char* python : {"/usr/bin/python3", "python3"})
        if (run_program({python, "-c", "import numpy, matplotlib"}, scratch.path()).succeeded()) return python;
    throw pbs::InputError("", 0, "report", "",
                          "no python3 that can import numpy and matplotlib: install python3-numpy and python3-matplotlib");
}

// Runs the scene that was just written. If it is refused, nothing of it is left behind.
RunResult run_new_scene(const std::string& scene_file, const std::string& folder, bool folder_is_new, int threads,
                        const std::vector<std::string>& warnings)
{
    try {
        Scene scene = read_scene(scene_file, {});
        for (DeformerSpec& spec : scene.deformers) spec.threads = threads;
        return run_scene(scene, folder, warnings);
    } catch (const pbs::InputError&) {
        std::error_code code;
        fs::remove(scene_file, code);
        if (folder_is_new) fs::remove(folder, code);  // fails if anything else is there
        throw;
    }
}

// The scene of an earlier trial is replaced. One that was changed since, or written by somebody else, is not.
void refuse_a_scene_of_the_user(const std::string& scene_file, const std::string& text)
{
    if (!fs::exists(scene_file)) return;
    const std::string found = pbs::read_text_file(scene_file, pbs::most_text_bytes);
    const fs::path facts_file = fs::path(scene_file).parent_path() / "try.json";
    const bool is_of_a_trial = fs::exists(facts_file) && pbs::JsonFile(facts_file.string()).at("scene_hash") == pbs::content_hash(found);
    if (found != text && !is_of_a_trial)
        throw pbs::InputError(scene_file, 0, "", "",
                              "exists and is not the scene of a trial: expected another folder (-o); `pbskin run` runs this scene");
}

int try_model(TrialOptions options, const CommonOptions& common)
{
    if (options.folder.empty()) options.folder = "results/" + fs::path(options.model).stem().string();
    const TrialScene made = [&] {
        const pbs::Stage stage("reading " + options.model);
        return trial_scene(options);
    }();
    const bool is_new = analysis::make_output_folder(options.folder);
    const std::string scene_file = (fs::path(options.folder) / "scene.toml").string();
    refuse_a_scene_of_the_user(scene_file, made.text);
    analysis::write_text_atomically(scene_file, made.text);

    const RunResult result = run_new_scene(scene_file, options.folder, is_new, common.threads, made.remarks);
    for (const auto& line : result.lines) spdlog::info("{}", line);
    nlohmann::json facts = trial_facts(options.folder);
    facts["scene_hash"] = pbs::content_hash(made.text);
    facts["summary"] = trial_sentence(facts);
    analysis::write_text_atomically((fs::path(options.folder) / "try.json").string(), analysis::record_text(facts));
    spdlog::info("{}", facts["summary"].get<std::string>());
    spdlog::info("To go on, change {} and run it with `pbskin run`.", scene_file);
    const int page = write_report_page(options.folder, common.quiet);
    if (result.failure().empty()) return page;
    spdlog::error("pbskin: {}", result.failure());
    return exit_breakdown;
}

}  // namespace

int write_report_page(const std::string& folder, bool quiet)
{
    if (!fs::is_directory(folder))
        throw pbs::InputError(folder, 0, "", "", "no such folder: expected one that `pbskin try`, `run` or `reproduce` wrote");
    if (!fs::is_regular_file(page_maker()))
        throw pbs::InputError(page_maker().string(), 0, "", "",
                              "not found: the page is made by scripts that are installed with the program");
    const pbs::Stage stage("making the page " + (fs::path(folder) / "report.html").string());
    std::vector<std::string> words = {python_that_draws(), "-B", page_maker().string(), folder};
    if (quiet) words.push_back("--quiet");
    const ProgramRun page = run_program(words, std::nullopt);
    if (!page.started) throw pbs::InputError("", 0, "report", words.front(), "cannot be started");
    return page.status >= 0 ? page.status : 128 - page.status;
}

// pbskin report DIR: writes the records and the figures drawn from them as one self-contained page, DIR/report.html.
void add_report_verb(CommandLine& line)
{
    auto folder = std::make_shared<std::string>();
    CLI::App* verb = line.add("report", "writes records and drawn figures on one self-contained HTML page and states what is missing",
                              [&common = line.common, folder] { return write_report_page(*folder, common.quiet); });
    verb->add_option("folder", *folder, "the folder that reproduce wrote; the page is report.html in it")->required();
}

void add_try_verb(CommandLine& line)
{
    auto options = std::make_shared<TrialOptions>();
    CLI::App* verb = line.add("try", "runs a rigged model through its own motion and shows the result on a page",
                              [&common = line.common, options] { return try_model(*options, common); });
    verb->add_option("model", options->model, ".glb .gltf .fbx .dae .zae")->required();
    verb->add_option("--animation", options->animation,
                     "an animation of the model by name, or a clip (.bvh .gltf .glb .fbx); by default the model's first one");
    verb->add_option("-o,--output", options->folder, "folder of the records; by default results/NAME");
    verb->add_option("--frames", options->frames, "largest number of frames, distributed over the motion")
        ->check(CLI::Range(2, 100'000))
        ->capture_default_str();
    verb->add_option("--vertices", options->vertices, "wanted number of vertices of the tets; by default 2000")
        ->check(CLI::Range(150, 10'000'000));
    verb->add_option("--skeleton", options->skeleton, "skeleton of a model without joints: a file, or human");
    verb->add_option("--scale", options->scale, "enlarges the model, for files that state a wrong unit");
    verb->add_flag("--allow-partial", options->allow_partial, "accepts a clip of which fewer than half of the moving joints match a bone");
    verb->add_flag_callback(
        "--no-reference", [options] { options->reference = false; }, "leaves out the finite elements, which take most of the time");
}

}  // namespace experiments
