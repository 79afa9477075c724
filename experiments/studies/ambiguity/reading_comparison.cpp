#include "experiments/studies/ambiguity/reading_comparison.hpp"

#include "experiments/studies/ambiguity/untouched.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace experiments {

const Reading& ReadingComparison::baseline_of(const Reading& reading) const
{
    return *std::find_if(readings_.begin(), readings_.end(),
                         [&](const Reading& other) { return other.place.empty() && other.name == reading.baseline; });
}

void ReadingComparison::measure(const std::vector<std::string>& claims, const Measure& measure)
{
    std::vector<Reading> measured;
    const auto add = [&](const Reading& reading) {
        const auto is_it = [&](const Reading& other) { return other.name == reading.name; };
        if (std::none_of(measured.begin(), measured.end(), is_it)) measured.push_back(reading);
    };
    for (const Reading& reading : readings_)
        for (const std::string& claim : claims) {
            if (reading.place.empty() || !untouched_because(claim, reading, baseline_of(reading)).empty()) continue;
            add(baseline_of(reading));
            add(reading);
        }
    const std::vector<ReadingFigures> figures = measure(measured);
    std::map<std::string, const ReadingFigures*> by_name;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        by_name[measured[i].name] = &figures.at(i);
        if (figures[i].broke_down) breakdown_ += fmt::format("{} ({}). ", measured[i].name, fmt::join(claims, ", "));
    }
    for (const Reading& reading : readings_)
        for (const std::string& claim : claims) {
            if (reading.place.empty()) continue;
            const std::string reason = untouched_because(claim, reading, baseline_of(reading));
            if (reason.empty())
                changes_.add(body_, claim, reading, *by_name.at(reading.baseline), *by_name.at(reading.name));
            else
                changes_.add_untouched(body_, claim, reading, reason);
        }
}

}  // namespace experiments
