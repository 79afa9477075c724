// pbskin reproduce [CLAIM or STUDY]... [-o DIR] [--quick, --full] [-j N] [--resume]
//                  [--external FILE] [--only RUN]...: runs studies and computes verdicts.
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/progress.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/verdicts/reproduce.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

namespace experiments {
namespace {

std::vector<std::string> studies_with_full(Extent in_full)
{
    std::vector<std::string> names;
    for (const Study& study : studies())
        if (study.sets.full == in_full) names.push_back(study.name);
    return names;
}

std::string meaning_of_full()
{
    return fmt::format("the whole studies; without names, only a part of {}, and nothing of {}",
                       fmt::join(studies_with_full(Extent::quick), ", "), fmt::join(studies_with_full(Extent::none), ", "));
}

}  // namespace

void add_reproduce_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "reproduce",
                              "runs studies, writes their records and computes verdicts; by default the studies of the quick set");
    auto arguments = std::make_shared<ReproduceArguments>();
    verb->add_option("names", arguments->names, "claims (C02) or studies (volume)");
    verb->add_option("-o,--output", arguments->folder, "folder of the records")->capture_default_str();
    auto* full = verb->add_flag("--full", arguments->full, meaning_of_full());
    auto quick = std::make_shared<bool>(false);
    verb->add_flag("--quick", *quick, "a part of each study that decides the same claims in minutes (default)")->excludes(full);
    verb->add_option("-j,--jobs", arguments->jobs, "number of runs in parallel")->check(CLI::Range(1, 256))->capture_default_str();
    auto* resume = verb->add_flag("--resume", arguments->resume, "keep the runs that are finished already");
    verb->add_flag("--cost", arguments->cost_only, "run nothing and print the expected time");
    auto* external = verb->add_option("--external", arguments->external,
                                      "a TOML file with [[external]] tables: deformers of your own for the study work_precision")
                         ->type_name("FILE");
    auto* only = verb->add_option("--only", arguments->only,
                                  "carries out this run alone, e.g. human_crouch, and keeps the others that are finished; may be given "
                                  "several times; by default all runs of the studies")
                     ->type_name("RUN")
                     ->expected(1)
                     ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    auto judge = std::make_shared<bool>(false);
    verb->add_flag("--judge", *judge, "run nothing and compute the verdicts from the records in the folder")
        ->excludes(full)
        ->excludes(resume)
        ->excludes(external)
        ->excludes(only);
    verb->callback([&action, &common, arguments, judge] {
        action = [&common, arguments, judge] {
            if (common.quiet) hide_progress();
            return *judge ? judge_again(*arguments) : reproduce(*arguments);
        };
    });
}

}  // namespace experiments
