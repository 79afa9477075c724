/* A deformer for pbskin as a shared library: each vertex follows the bone with its largest weight.
     cc -O2 -shared -fPIC -I .. rigid_skinning.c -o librigid_skinning.so */
#include "pbskin_deformer.h"

#include <stdlib.h>

struct rigid_skinning {
    int vertices;
    double* rest; /* vertices x 3 */
    int* bone;    /* of each vertex */
};

int pbskin_deformer_version(void) { return PBSKIN_DEFORMER_VERSION; }

void pbskin_deformer_destroy(void* deformer)
{
    struct rigid_skinning* self = deformer;
    free(self->rest);
    free(self->bone);
    free(self);
}

void* pbskin_deformer_create(const struct pbskin_character* character)
{
    const int bones = character->bones;
    struct rigid_skinning* made = calloc(1, sizeof *made);
    if (!made) return NULL;
    made->vertices = character->vertices;
    made->rest = malloc(3 * made->vertices * sizeof(double));
    made->bone = malloc(made->vertices * sizeof(int));
    if (!made->rest || !made->bone) {
        pbskin_deformer_destroy(made);
        return NULL;
    }
    for (int i = 0; i < 3 * made->vertices; ++i) made->rest[i] = character->rest[i];
    for (int v = 0; v < made->vertices; ++v) {
        made->bone[v] = 0;
        for (int b = 1; b < bones; ++b)
            if (character->weights[v * bones + b] > character->weights[v * bones + made->bone[v]]) made->bone[v] = b;
    }
    return made;
}

int pbskin_deformer_advance(void* deformer, const double* pose, double time_step_s, double* positions)
{
    const struct rigid_skinning* self = deformer;
    (void)time_step_s;
    for (int v = 0; v < self->vertices; ++v)
        for (int row = 0; row < 3; ++row) {
            const double* transform = pose + 12 * self->bone[v] + 4 * row;
            const double* x = self->rest + 3 * v;
            positions[3 * v + row] = transform[0] * x[0] + transform[1] * x[1] + transform[2] * x[2] + transform[3];
        }
    return 0;
}
