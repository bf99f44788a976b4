/* patches_internal.h - a set of patches while it is made.
   Private to this module. */
#pragma once
#include "surface/patches.h"

/* Edges 0..3 of a patch: v = 0, v = 1, u = 0, u = 1; each runs towards larger u or v. */
typedef struct WrPatchEdge {
    int32_t other;  /* 4 * patch + edge that it is shared with; -1: none */
    bool turned;    /* the other one runs the other way */
    bool collapsed; /* its four points are one */
    bool
        backward; /* what is worked out along it begins at its end, so that both neighbours have the same bits */
} WrPatchEdge;

/* The number of the edge's point i = 0..3 among the patch's sixteen. */
static inline int wr_patch_edge_point(int edge, int i)
{
    return edge < 2 ? 12 * edge + i : 3 * (edge - 2) + 4 * i;
}

/* Sets that are joined: up[i] leads from a member to the next, the root's to itself. Shortens the way as it goes. */
static inline int32_t wr_root_of(int32_t *up, int32_t i)
{
    while (up[i] != i) {
        up[i] = up[up[i]];
        i = up[i];
    }
    return i;
}

/* Patches that hang together shall face to one side, that of most; all: and then each to the other one. u and v of those
 * that do not change places; how many. */
bool wr_patches_face(float (*points)[48], int32_t count, bool all, int32_t *turned, WrError *err);
/* Which edges are shared: edges [4 count]. */
bool wr_patches_find_edges(const float (*points)[48], int32_t count, WrPatchEdge *edges,
                           WrPatchesTold *told, WrError *err);
/* The charts, by set->table; counts what they join. */
bool wr_patches_lay_out(WrPatches *set, WrPatch *patch, const WrPatchEdge *edges, WrError *err);
