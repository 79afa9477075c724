#include "experiments/process/warnings.hpp"

#include <spdlog/spdlog.h>

namespace experiments {

void warn(const std::vector<std::string>& remarks)
{
    for (const std::string& remark : remarks) spdlog::warn("pbskin: warning: {}", remark);
}

}  // namespace experiments
