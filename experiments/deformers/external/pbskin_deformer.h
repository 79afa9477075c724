/* The functions of a shared library that pbskin uses as a deformer: [[external]] with the key `library`. Arrays are by rows, lengths in
   metres. The library copies what it needs of the character. */
#ifndef PBSKIN_DEFORMER_H
#define PBSKIN_DEFORMER_H

#ifdef __cplusplus
extern "C" {
#endif

#define PBSKIN_DEFORMER_VERSION 1

/* Returns PBSKIN_DEFORMER_VERSION. A library that was compiled with another version of this file is refused. */
int pbskin_deformer_version(void);

struct pbskin_character {
    int vertices, tets, bones;
    const double* rest;       /* vertices x 3 */
    const int* tet_vertices;  /* tets x 4, from 0 */
    const double* weights;    /* vertices x bones, each row sums to one */
    const double* bone_ends;  /* bones x 6: head and tail at rest */
    const int* bone_parents;  /* bones; -1: a root */
};

/* A deformer of this character, at rest; null: it cannot be made. */
void* pbskin_deformer_create(const struct pbskin_character* character);

/* Deforms to a pose: for each bone the upper three rows of the transform that carries rest points to the pose (bones x 12). Writes
   vertices x 3 positions. Returns 0, or another number for a failure. */
int pbskin_deformer_advance(void* deformer, const double* pose, double time_step_s, double* positions);

void pbskin_deformer_destroy(void* deformer);

#ifdef __cplusplus
}
#endif
#endif
