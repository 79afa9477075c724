#include "analysis/records/kept_record.hpp"

#include "analysis/records/atomic_file.hpp"
#include "pbs/geometry/input_error.hpp"

namespace analysis {

nlohmann::json read_record(const std::string& path)
{
    nlohmann::json record = nlohmann::json::parse(analysis::read_text(path), nullptr, false);
    if (record.is_discarded()) refuse_record(path);
    return record;
}

void refuse_record(const std::string& path)
{
    throw pbs::InputError(path, 0, "", "", "expected a record as this program writes it: it was changed, or cut short");
}

}  // namespace analysis
