#include "experiments/run/cost_record.hpp"

#include <link.h>
#include <nlohmann/json.hpp>

namespace experiments {
namespace {

int loaded_shared_objects()
{
    int count = 0;
    const auto add = [](dl_phdr_info* info, std::size_t, void* counter) {
        if (info->dlpi_name && *info->dlpi_name) ++*static_cast<int*>(counter);  // the program itself has no name
        return 0;
    };
    dl_iterate_phdr(add, &count);
    return count;
}

}  // namespace

double CostRecord::seconds(const std::string& part) const
{
    const auto found = seconds_.find(part);
    return found == seconds_.end() ? 0.0 : found->second;
}

nlohmann::json CostRecord::json() const
{
    nlohmann::json seconds = seconds_, cpu_seconds = cpu_seconds_;
    seconds["total"] = stopwatch_.seconds();
    cpu_seconds["total"] = process_cpu_s() - cpu_start_s_;
    seconds["deformers"] = deformers_;
    cpu_seconds["deformers"] = cpu_deformers_;
    return {{"seconds", seconds},
            {"cpu_seconds", cpu_seconds},
            {"peak_memory_mb", 1e-6 * peak_memory_bytes()},
            {"shared_objects", loaded_shared_objects()}};
}

}  // namespace experiments
