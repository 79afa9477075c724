// The page that the scripts of paper_figures make of a folder of records.
#pragma once

#include <string>

namespace experiments {

// Writes `folder`/report.html. The page maker replaces this process: it reports what is missing, and its exit status is that of the
// program. InputErrors: no such folder, no python3 with the packages that draw, no page maker.
int write_report_page(const std::string& folder, bool quiet);

}  // namespace experiments
