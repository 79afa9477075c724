// A record of a run, read back: somebody else may have made something else of it.
//   const double total_s = from_record(folder + "/run.json", [](const auto& run) { return run.at("cost").at("total").get<double>(); });
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace analysis {

nlohmann::json read_record(const std::string& path);       // InputError where it is no JSON
[[noreturn]] void refuse_record(const std::string& path);  // an InputError

// What `read` makes of it; InputError with the file where an entry is missing or of another type.
template <typename Read>
auto from_record(const std::string& path, const Read& read)
{
    const nlohmann::json record = read_record(path);
    try {
        return read(record);
    } catch (const nlohmann::json::exception&) {
        refuse_record(path);
    }
}

}  // namespace analysis
