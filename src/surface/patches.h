/* patches.h - sets of bicubic Bezier patches, such as the teapot.

   Each patch is cut into triangles, which rays intersect (triangles.h); position, normal and tangents
   are then the patch's own, at the (u,v) of the hit (formulas in bezier.h). Object space, the file's
   own unit and axes. Independent of files. Immutable once created.

   Patches that share a whole edge, bit for bit, in either direction, are neighbours, and have the same
   points along it: no ray passes between them (HC85). An edge whose four points are equal has no
   length: the normal there is the limit described in bezier.h.

   The part of the table on a patch (WrPatchTable) is given by a chart, the same form for all modes:

     table's u = (c[0] + c[1] u + c[2] v) scale_u      v = (c[3] + c[4] u + c[5] v) scale_v

   with integer c (except WR_PATCH_OWN): a rotation by quarter turns, mirrored or not, and a cell. So
   along a joined edge both neighbours have the same table position, with the same bits, and the table
   continues across it (HC151). */
#pragma once
#include "surface/surface.h"
#include "surface/triangles.h"

#define WR_PATCHES_MAX WR_TRIANGLE_PARTS_MAX
#define WR_PATCH_CUTS_MAX 64
#define WR_PATCH_MARGIN WR_CELL_MARGIN /* margin of WR_PATCH_OWN */
/* Maximum distance of a triangle from its patch, as a fraction of the set's radius, while there are no
 * more than WR_PATCH_TRIANGLES. */
#define WR_PATCH_OFF (1.0 / 4000)
#define WR_PATCH_TRIANGLES 1000000

typedef enum WrPatchTable {
    WR_PATCH_EACH,   /* the whole table, by its own u and v */
    WR_PATCH_JOINED, /* the whole table, rotated so that it continues across shared edges */
    WR_PATCH_SPLIT,  /* a cell of one table, on which the set is unfolded */
    WR_PATCH_OWN,    /* a separate cell of one table, within a margin: no other cell is visible */
    WR_PATCH_TABLES
} WrPatchTable;
extern const char *const wr_patch_tables[WR_PATCH_TABLES];

/* Layout for kernels: floats only. */
typedef struct WrPatch {
    float
        point[48]; /* as in bezier.h: x, y, z of sixteen points, four along u, then the next row */
    float chart[6];
    float reach_u, reach_v; /* half extent of a triangle: possible error of its (u,v) */
} WrPatch;

/* Statistics and repairs, for reports. */
typedef struct WrPatchesReport {
    int32_t shared;      /* edges shared by two patches */
    int32_t open, loops; /* edges of one patch, and the number of loops and lines they form */
    int32_t collapsed;   /* edges without length */
    int32_t crowded;     /* edges of more than two patches */
    int32_t turned;  /* patches whose u and v were exchanged, to face the same side as the others */
    int32_t against; /* shared edges whose patches still face different sides */
    int32_t joined;  /* shared edges across which the table continues */
    int32_t creased; /* shared edges where normals differ by 0.1 degrees or more */
    double crease_deg;    /* the largest of these angles under 45 degrees ... */
    int32_t crease_of[2]; /* ... and its patches, from 0 */
} WrPatchesReport;

struct WrPatches {
    const WrPatch *patch; /* [count], owned */
    const int32_t *of;    /* [triangles], patch of each triangle; owned */
    int32_t count;
    WrPatchTable table;
    double scale_u, scale_v;
    int32_t columns, rows; /* cells of the unfolded set; otherwise 1, 1 */
    WrPatchesReport report;
};

/* Creates a set cut into triangles; points: [count] patches of 48 numbers, finite and within 1e30.
 * Errors: no patch has an area; too many; out of memory. */
WrTriangles *wr_patches_new(const float (*points)[48], int32_t count, WrPatchTable table,
                            WrError *err);
void wr_patches_free(WrPatches *patches); /* NULL is allowed */

/* Parses patches from a text in one of two forms:
 *    COUNT, then for each patch "3 3" and sixteen points;                                    "bpt"
 *    COUNT, then for each sixteen indices of points from 1, then COUNT of points, then these. the classic list
 * Numbers are separated by spaces, line ends or commas; # begins a comment. The caller frees *points
 * (wr_free). Errors name the line. */
bool wr_patches_parse(const char *text, size_t length, float (**points)[48], int32_t *count,
                      WrError *err);

/* Serialises a set as floats, bit for bit, like wr_triangles_serialize; the block begins with a number that
 * no mesh begins with. */
#define WR_PATCHES_PACKED 2
float *wr_patches_serialize(const WrPatches *patches, size_t *count);
WrTriangles *wr_patches_deserialize(const float *block, size_t count, WrError *err);

/* The table position of the patch's (u,v). */
static inline void wr_patch_chart(const WrPatches *patches, const WrPatch *patch, double u,
                                  double v, double *table_u, double *table_v)
{
    const float *c = patch->chart;
    *table_u = ((double)c[0] + (double)c[1] * u + (double)c[2] * v) * patches->scale_u;
    *table_v = ((double)c[3] + (double)c[4] * u + (double)c[5] * v) * patches->scale_v;
}
