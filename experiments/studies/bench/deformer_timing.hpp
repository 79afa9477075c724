// How long a frame and an iteration of every registered deformer take, in each precision and order that it offers, relative to the plain
// implementation of the same method in the same run.
//   for (const DeformerTiming& timing : time_deformers(body, rounds)) ...
// The list is the registry's: a deformer with a key `precision`, `order` or `packed` is timed for each of its values. Processor time of
// one thread.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/studies/bench/bench_body.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct DeformerKind;

// A deformer's kind with one choice of its options. The plain one is in f64, or in the order `plain`.
struct DeformerSetting {
    DeformerSpec spec;
    std::optional<DeformerSpec> twice;  // with twice the iterations; nothing if it has no key `iterations`
    // order: that of the key, or `packed` or `plain` of a kind with the key `packed`; empty without either key. precision: that of its
    // traits without a key.
    std::string order, precision;
    std::size_t plain = 0;  // its place in the list of the kind's settings
};

// One per value of `order`, `precision` and `packed`, of which plain code has f64 alone. The key of a list counts as that of its first
// table.
std::vector<DeformerSetting> deformer_settings(const DeformerKind& kind);

struct DeformerTiming {
    std::string deformer = {};
    std::string order = {}, precision = {};
    std::optional<int> iterations = {};                 // per frame
    std::optional<Spread> ms_frame = {};                // nothing if it was left out
    std::optional<Spread> ms_iteration = {};            // that one more adds; without a key `iterations`, the frame over their number
    std::optional<Spread> ns_tet = {}, ns_vertex = {};  // per iteration, or per frame of a deformer without iterations
    std::optional<Spread> ratio_to_plain = {};          // time of the plain implementation of an iteration, or a frame, over this one's
    std::string left_out = {};                          // the reason
};

std::vector<DeformerTiming> time_deformers(const BenchBody& body, const Rounds& rounds);

}  // namespace experiments
