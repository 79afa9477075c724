// The keys of the fuzzed scenes: all types of value, tables in tables and lists of tables. The registry is left out,
// since it would bring every deformer into the instrumented program.
#pragma once

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"

inline const experiments::SceneSchema& fuzzed_schema()
{
    using namespace experiments;
    static const SceneSchema schema =
        scene_schema({{.name = "pbs", .keys = pbs_fields().keys()}, {.name = "fem", .keys = fem_fields().keys()}});
    return schema;
}
