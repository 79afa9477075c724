// A remark for the user of a result, and how grave it is.
//   remarks.push_back({Gravity::part_left_out, "hero.glb: the node Sword is left out"});
#pragma once

#include <string>
#include <vector>

namespace pbs {

// The one rule by which remarks are ordered: how much of a result they put in doubt, the gravest first.
enum class Gravity {
    results_wrong,  // what moves is not what the files mean: nothing moves, the pose or the tets are not those of the
                    // model
    comparison_wrong,  // the results are those of the model, and something that they are compared with is wrong
    part_left_out,     // a part of the model or of its motion is missing or only approximated
    information        // nothing is wrong: it is always a note and never a warning
};

struct Remark {
    Gravity gravity;
    std::string text;  // one sentence that begins with the file

    bool operator==(const Remark&) const = default;
};
using RemarkList = std::vector<Remark>;

}  // namespace pbs
