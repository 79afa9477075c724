// The remarks of a run, on the terminal and in run.json: at most three warnings, the gravest first, and the rest as
// notes.
//   RunRemarks remarks(of_the_caller);
//   remarks.add(pbs::Gravity::part_left_out, {"hero.glb: ..."});
//   remarks.say_all();   outcome["warnings"] = remarks.warnings();   outcome["notes"] = remarks.notes();
#pragma once

#include "experiments/characters/remark.hpp"
#include "experiments/scene/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

class RunRemarks {
public:
    static constexpr std::size_t most_warnings = 3;

    RunRemarks() = default;
    explicit RunRemarks(const Remarks& of_caller);
    ~RunRemarks() { say_all(); }  // also of a run that is refused
    RunRemarks(const RunRemarks&) = delete;
    RunRemarks& operator=(const RunRemarks&) = delete;

    // Each text counts once. Notes, and the first warnings that make results wrong, are printed at once, so that a user
    // can stop the run. The others are printed at its end or by an interruption.
    void add(const pbs::RemarkList& remarks);
    void add(pbs::Gravity gravity, const std::vector<std::string>& texts);

    void say_all();  // prints what was not printed yet

    // A sentence that an interruption prints, too; empty: none.
    void set_words_of_interruption(const std::string& words);

    // For records, which name files without folders of the machine: "folder/hero.glb: no joint moves" -> "hero.glb: no
    // joint moves".
    std::vector<std::string> warnings() const;
    std::vector<std::string> notes() const;  // what would be a warning if there were fewer comes first

private:
    struct Entry {
        pbs::Remark remark;
        std::string recorded;
        bool is_said = false;
    };
    void say(Entry& entry, const char* kind);
    void announce() const;  // what an interruption is to print
    const char* kind_of(std::size_t entry) const;
    std::size_t warning_count() const;

    std::string of_interruption_;
    std::vector<Entry> entries_;  // the gravest first, otherwise in order of time
};

}  // namespace experiments
