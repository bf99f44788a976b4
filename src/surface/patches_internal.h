/* patches_internal.h - internals of the construction of patch sets.
   Private to this module. */
#pragma once
#include "surface/patches.h"

/* Edges 0..3 of a patch: v = 0, v = 1, u = 0, u = 1; each runs towards larger u or v. */
typedef struct WrPatchEdge {
    int32_t other;  /* 4 * patch + edge of the neighbour; -1: none */
    bool turned;    /* the neighbour's edge has the opposite direction */
    bool collapsed; /* its four points are equal */
    bool backward;  /* points along it are computed from its end, so that both neighbours have the
                     same bits */
} WrPatchEdge;

/* The index of the edge's point i = 0..3 among the patch's sixteen. */
static inline int wr_patch_edge_point(int edge, int i)
{
    return edge < 2 ? 12 * edge + i : 3 * (edge - 2) + 4 * i;
}

/* Union-find: up[i] is the parent of a member, the root's is itself. Shortens the path. */
static inline int32_t wr_root_of(int32_t *up, int32_t i)
{
    while (up[i] != i) {
        up[i] = up[up[i]];
        i = up[i];
    }
    return i;
}

/* Orients connected patches to one side, that of the majority; all: then flips all of them. Flipping
 * exchanges u and v; *turned is their number. */
bool wr_patches_face(float (*points)[48], int32_t count, bool all, int32_t *turned, WrError *err);
/* Finds the shared edges: edges [4 count]. */
bool wr_patches_find_edges(const float (*points)[48], int32_t count, WrPatchEdge *edges,
                           WrPatchesTold *told, WrError *err);
/* Computes the charts for set->table; counts the joined edges. */
bool wr_patches_lay_out(WrPatches *set, WrPatch *patch, const WrPatchEdge *edges, WrError *err);
