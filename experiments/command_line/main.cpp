// pbskin: a verification suite for position based skinning.
//   pbskin run limb_twist -o results/limb_twist        one scene: frames and records
//   pbskin reproduce volume --quick                    studies -> records -> verdicts
//   pbskin measure rest.msh frame_*.vtu --max-volume-change 0.5
#include "analysis/records/provenance.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace experiments {

CLI::App* CommandLine::add(const std::string& name, const std::string& meaning, const std::string& example,
                           const std::function<int()>& its_action)
{
    CLI::App* verb = app.add_subcommand(name, meaning);
    verb->footer("Example: " + example);
    verb->callback([this, its_action] { action = its_action; });
    verb->add_flag("--quiet", common.quiet, "errors only");
    verb->add_flag("--verbose", common.verbose, "print more: the results of each run of a study");
    verb->add_option("--threads", common.threads,
                     "threads of a deformer on a large mesh (run, try, check; by default 1) or of the timings (bench; "
                     "by default "
                     "all cores)")
        ->check(CLI::Range(1, 1024));
    return verb;
}

void say_next(const std::string& words)
{
    std::fflush(stdout);
    spdlog::info("next: {}", words);
}

namespace {

// Help whose lines fit the terminal, up to 100 characters. Only options have long texts.
class HelpOfOneScreen : public CLI::Formatter {
    std::string make_option_desc(const CLI::Option* option) const override
    {
        const std::size_t width = std::clamp<std::size_t>(terminal_width(), 60, 100) - column_width_;
        return fmt::format("{}", fmt::join(analysis::wrapped(option->get_description(), width), "\n"));
    }
};

std::string version_text(bool as_json)
{
    const analysis::Provenance build = analysis::collect_provenance(1);
    if (as_json)
        return nlohmann::json{{"version", build.version},
                              {"git_revision", build.git_revision},
                              {"git_dirty", build.git_dirty},
                              {"compiler", build.compiler},
                              {"build_type", build.build_type}}
            .dump(2);
    return fmt::format("pbskin {} (git {}{}; {}, {})", build.version, build.git_revision.substr(0, 12),
                       build.git_dirty ? ", dirty" : "", build.compiler, build.build_type);
}

void start_log(const CommonOptions& common)
{
    auto log = spdlog::stderr_color_mt(
        "pbskin", std::getenv("NO_COLOR") ? spdlog::color_mode::never : spdlog::color_mode::automatic);
    log->set_pattern("%v");
    log->set_level(common.quiet ? spdlog::level::err : common.verbose ? spdlog::level::debug : spdlog::level::info);
    spdlog::set_default_logger(log);
}

// The first word, where it is no verb and no option: CLI11 states only that a verb is missing. Empty in all other
// cases.
std::string unknown_word(const CLI::App& app)
{
    const std::vector<std::string> left = app.remaining();
    if (left.empty() || !app.get_subcommands().empty() || app.get_parent()) return "";
    if (left.front().starts_with("-")) return left.front() + ": unknown option";
    std::vector<std::string> verbs;
    for (const CLI::App* verb : app.get_subcommands([](const CLI::App* known) { return !known->get_group().empty(); }))
        verbs.push_back(verb->get_name());
    return left.front() + ": unknown verb; the nearest known one is " + pbs::nearest_name(left.front(), verbs);
}

int parse_and_act(int argc, char** argv)
{
    CLI::App app("pbskin: a verification suite for position based skinning", "pbskin");
    app.formatter(std::make_shared<HelpOfOneScreen>());
    app.footer("Example: pbskin run limb_twist, then pbskin report results/limb_twist");
    bool as_json = false;  // declared before --version, whose callback reads it
    CLI::Option* json = app.add_flag("--json", as_json, "with --version: for programs, with the whole git revision");
    json->needs(app.set_version_flag("--version", [&] { return version_text(as_json); }));
    app.add_flag_callback("--describe", [&app] { throw CLI::CallForVersion(describe(app), 0); })->group("");
    app.require_subcommand(1);
    CommandLine line{app};
    for (const auto add : {add_list_verb, add_explain_verb, add_try_verb, add_run_verb, add_reproduce_verb,
                           add_check_verb, add_measure_verb, add_references_verb, add_compare_verb, add_mesh_verb,
                           add_bench_verb, add_fetch_verb, add_report_verb})
        add(line);
    app.failure_message([](const CLI::App* failed, const CLI::Error& error) {
        return "pbskin: " + (unknown_word(*failed).empty() ? std::string(error.what()) : unknown_word(*failed)) +
               "; `pbskin --help` lists the verbs, `pbskin VERB --help` their options\n";
    });
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_finished : exit_input;
    }
    start_log(line.common);
    if (line.common.quiet) hide_progress();
    watch_interrupts();
    return line.action();
}

int reported(const Failure& failure)
{
    std::fprintf(stderr, "pbskin: %s\n", failure.message().c_str());
    return failure.status;
}

// Output may stay in a buffer until the end, so that a full disk shows only here.
bool output_is_lost()
{
    return std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
}

}  // namespace
}  // namespace experiments

int main(int argc, char** argv)
{
    try {
        const int status = experiments::parse_and_act(argc, argv);
        if (!experiments::output_is_lost()) return status;
    } catch (...) {
        if (!experiments::output_is_lost()) return experiments::reported(experiments::caught_failure());
    }
    return experiments::reported({"standard output: cannot be written", experiments::exit_input});
}
