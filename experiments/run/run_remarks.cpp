#include "experiments/run/run_remarks.hpp"

#include "experiments/characters/body_cache.hpp"
#include "experiments/process/terminal.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace experiments {
namespace {

std::string without_folder(const std::string& text)
{
    const std::size_t end = text.find(": ");
    return end == std::string::npos ? text : pbs::file_name(text.substr(0, end)) + text.substr(end);
}

}  // namespace

RunRemarks::RunRemarks(const Remarks& of_caller)
{
    add(pbs::Gravity::part_left_out, of_caller.warnings);
    add(pbs::Gravity::information, of_caller.notes);
}

void RunRemarks::add(const pbs::RemarkList& remarks)
{
    for (const pbs::Remark& remark : remarks) {
        const std::string recorded = without_folder(remark.text);
        if (std::ranges::count(entries_, recorded, &Entry::recorded) > 0) continue;
        const auto before = std::ranges::upper_bound(entries_, remark.gravity, {},
                                                     [](const Entry& entry) { return entry.remark.gravity; });
        const auto added = entries_.insert(before, Entry{remark, recorded});
        if (remark.gravity == pbs::Gravity::information)
            say(*added, "note");
        else if (remark.gravity == pbs::Gravity::results_wrong &&
                 added - entries_.begin() < std::ptrdiff_t{most_warnings})
            say(*added, "warning");
    }
    announce();
}

void RunRemarks::add(pbs::Gravity gravity, const std::vector<std::string>& texts)
{
    for (const std::string& text : texts) add({{gravity, text}});
}

void RunRemarks::say(Entry& entry, const char* kind)
{
    if (!entry.is_said) spdlog::warn("pbskin: {}: {}", kind, entry.remark.text);
    entry.is_said = true;
}

void RunRemarks::announce() const
{
    std::string text;
    for (std::size_t e = 0; e < entries_.size() && spdlog::should_log(spdlog::level::warn); ++e)
        if (!entries_[e].is_said) text += fmt::format("pbskin: {}: {}\n", kind_of(e), entries_[e].remark.text);
    say_when_interrupted(text + of_interruption_);
}

void RunRemarks::set_words_of_interruption(const std::string& words)
{
    of_interruption_ = words.empty() ? "" : fmt::format("pbskin: {}\n", words);
    announce();
}

void RunRemarks::say_all()
{
    for (std::size_t e = 0; e < entries_.size(); ++e) say(entries_[e], kind_of(e));
    announce();
}

const char* RunRemarks::kind_of(std::size_t entry) const
{
    return entry < warning_count() ? "warning" : "note";
}

std::size_t RunRemarks::warning_count() const
{
    const auto notes = std::ranges::count(entries_, pbs::Gravity::information,
                                          [](const Entry& entry) { return entry.remark.gravity; });
    return std::min(most_warnings, entries_.size() - static_cast<std::size_t>(notes));
}

std::vector<std::string> RunRemarks::warnings() const
{
    std::vector<std::string> texts;
    for (std::size_t e = 0; e < warning_count(); ++e) texts.push_back(entries_[e].recorded);
    return texts;
}

std::vector<std::string> RunRemarks::notes() const
{
    std::vector<std::string> texts;
    for (std::size_t e = warning_count(); e < entries_.size(); ++e) texts.push_back(entries_[e].recorded);
    return texts;
}

}  // namespace experiments
