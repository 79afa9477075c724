// pbskin report DIR: writes the records and the figures drawn from them as one self-contained page, DIR/report.html.
#include "experiments/command_line/report_page.hpp"
#include "experiments/command_line/verbs.hpp"

namespace experiments {

void add_report_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb =
        add_verb(app, common, "report", "writes records and drawn figures on one self-contained HTML page and states what is missing");
    auto folder = std::make_shared<std::string>();
    verb->add_option("folder", *folder, "the folder that reproduce wrote; the page is report.html in it")->required();
    verb->callback([&action, &common, folder] { action = [&common, folder] { return write_report_page(*folder, common.quiet); }; });
}

}  // namespace experiments
