/* patches.h - sets of bicubic Bezier patches: the teapot. Each is cut into triangles, by which rays find it (triangles.h);
   place, normal and tangents are then its own, at the (u,v) where the ray meets it (bezier.h has the formulas).
   Object space, the file's own unit and axes. Knows no files. Immutable once made.

   Patches that share a whole edge, bit for bit, either way round, are neighbours, and have the same places along it: no
   ray passes between them (HC85). An edge whose four points are one has no length: the normal there is the limit that
   bezier.h tells of.

   Which part of the table a patch has (WrPatchTable) is a chart, the same for all three:
     table's u = (c[0] + c[1] u + c[2] v) scale_u      v = (c[3] + c[4] u + c[5] v) scale_v
   with whole c (but for WR_PATCH_OWN): a turn by quarters, mirrored or not, and a cell. So along an edge that is joined both neighbours have the
   same place of the table, with the same bits, and the table runs on beyond it (HC151). */
#pragma once
#include "surface/surface.h"
#include "surface/triangles.h"

#define WR_PATCHES_MAX WR_TRIANGLE_PARTS_MAX
#define WR_PATCH_CUTS_MAX 64
#define WR_PATCH_MARGIN WR_CELL_MARGIN /* of WR_PATCH_OWN */
/* How far a triangle is from its patch at most, in parts of the set's radius, while there are no more than
 * WR_PATCH_TRIANGLES. */
#define WR_PATCH_OFF (1.0 / 4000)
#define WR_PATCH_TRIANGLES 1000000

typedef enum WrPatchTable {
    WR_PATCH_EACH,   /* the whole table, by its own u and v */
    WR_PATCH_JOINED, /* the whole table, turned so that it runs on across shared edges */
    WR_PATCH_SPLIT,  /* a cell of one table, on which the set is unfolded */
    WR_PATCH_OWN, /* a cell of its own of one table, within a margin: nothing of other cells shows */
    WR_PATCH_TABLES
} WrPatchTable;
extern const char *const wr_patch_tables[WR_PATCH_TABLES];

/* As kernels look it up: floats alone. */
typedef struct WrPatch {
    float point[48]; /* as bezier.h: x, y, z of sixteen, four along u, then the next row */
    float chart[6];
    float reach_u, reach_v; /* of one of its triangles: so far its (u,v) may be off */
} WrPatch;

/* What was found, for whoever is told. */
typedef struct WrPatchesTold {
    int32_t shared;      /* edges of two patches */
    int32_t open, loops; /* edges of one, and how many rings and lines they make */
    int32_t collapsed;   /* without length */
    int32_t crowded;     /* of more than two */
    int32_t turned;    /* patches whose u and v changed places, to face to the side of the others */
    int32_t against;   /* shared ones whose patches face to different sides even so */
    int32_t joined;    /* shared ones across which the table runs on */
    int32_t creased;   /* shared ones where normals differ by 0.1 degrees and more */
    double crease_deg; /* the greatest of these angles under 45 degrees ... */
    int32_t crease_of[2]; /* ... and its patches, from 0 */
} WrPatchesTold;

struct WrPatches {
    const WrPatch *patch; /* [count], owned */
    const int32_t *of;    /* [triangles], whose triangle each is; owned */
    int32_t count;
    WrPatchTable table;
    double scale_u, scale_v;
    int32_t columns, rows; /* of the unfolded set's cells; 1, 1 */
    WrPatchesTold told;
};

/* Cut into triangles; points: [count] patches of 48 numbers, finite and within 1e30. Errors: none with an area; too many;
 * no memory. */
WrTriangles *wr_patches_new(const float (*points)[48], int32_t count, WrPatchTable table,
                            WrError *err);
void wr_patches_free(WrPatches *patches); /* fine on NULL */

/* Patches from a text, of one of two forms:
 *   COUNT, then of each patch "3 3" and sixteen points;                                     "bpt"
 *   COUNT, then of each sixteen numbers of points from 1, then COUNT of points, then these. the classic list
 * Numbers stand apart by spaces, line ends or commas; # begins a remark. The caller frees *points (wr_free). Errors name
 * the line. */
bool wr_patches_parse(const char *text, size_t length, float (**points)[48], int32_t *count,
                      WrError *err);

/* A set as a run of floats, bit for bit, as wr_triangles_pack has a mesh; the block begins with a number that no mesh
 * begins with. */
#define WR_PATCHES_PACKED 2
float *wr_patches_pack(const WrPatches *patches, size_t *count);
WrTriangles *wr_patches_unpack(const float *block, size_t count, WrError *err);

/* The table's place of the patch's (u,v). */
static inline void wr_patch_chart(const WrPatches *patches, const WrPatch *patch, double u,
                                  double v, double *table_u, double *table_v)
{
    const float *c = patch->chart;
    *table_u = ((double)c[0] + (double)c[1] * u + (double)c[2] * v) * patches->scale_u;
    *table_v = ((double)c[3] + (double)c[4] * u + (double)c[5] * v) * patches->scale_v;
}
