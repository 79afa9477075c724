// The page that the scripts of paper_figures make of a folder of records.
#pragma once

#include <string>

namespace experiments {

// Writes `folder`/report.html. The page maker runs as a process of its own, which reports what is missing. Returns its exit status.
// InputErrors: no such folder, no python3 with the packages that draw, no page maker.
int write_report_page(const std::string& folder, bool quiet);

}  // namespace experiments
