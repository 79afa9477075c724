// The keys of the fuzzed scenes: all types of value, tables in tables and lists of tables. The registry is left out, since it would bring
// every deformer into the instrumented program.
#pragma once

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"

inline const experiments::SceneSchema& fuzzed_schema()
{
    static const experiments::SceneSchema schema = [] {
        experiments::SceneSchema all{experiments::character_and_motion_keys()};
        for (const auto& keys : {experiments::pbs_fields().keys(), experiments::fem_fields().keys(), experiments::output_keys()})
            all.keys.insert(all.keys.end(), keys.begin(), keys.end());
        return all;
    }();
    return schema;
}
