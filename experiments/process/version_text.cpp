#include "experiments/process/version_text.hpp"

#include "analysis/records/provenance.hpp"

#include <fmt/format.h>

namespace experiments {

std::string version_text()
{
    const analysis::Provenance facts = analysis::collect_provenance(1);
    return fmt::format("pbskin {} (git {}{}; {}, {})", facts.version, facts.git_revision.substr(0, 12), facts.git_dirty ? ", dirty" : "",
                       facts.compiler, facts.build_type);
}

}  // namespace experiments
