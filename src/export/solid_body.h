/* solid_body.h - triangles of a solid in millimetres, and their files: STL, PLY, OBJ, 3MF.
   Private to this module. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;

#define WR_SOLID_MAX                                                                               \
    4000000 /* maximum triangles of a relief; with its back no more than readers accept */

/* Triangles share points by number, so a body is watertight by construction. Zero-initialise; fini frees. */
typedef struct WrSolidBody {
    float (*points)[3];      /* mm */
    int32_t (*triangles)[3]; /* anticlockwise from outside */
    float (*uv)[3][2]; /* of their corners, in cells: may differ between triangles at a point */
    int32_t point_count, point_room, triangle_count, triangle_room;
} WrSolidBody;

void wr_solid_body_fini(WrSolidBody *body);
int32_t wr_solid_body_add_point(WrSolidBody *body, const float at[3]); /* returns its number */
void wr_solid_body_add_triangle(WrSolidBody *body, const int32_t corners[3], float uv[3][2]);
WrVec3 wr_solid_body_point(const WrSolidBody *body, int32_t i);
/* Area vector: twice the area along the normal. */
WrVec3 wr_solid_body_area(const WrSolidBody *body, int32_t a, int32_t b, int32_t c);
/* Divergence theorem: V = 1/6 sum over triangles of a . (b x c), positive if they are anticlockwise seen from
   outside. mm^3; meaningless for an open mesh. */
double wr_solid_body_volume(const WrSolidBody *body);
/* Reverses all triangles. */
void wr_solid_body_reverse(WrSolidBody *body);
void wr_solid_body_bounds(const WrSolidBody *body, WrVec3 *low, WrVec3 *high);
/* Writes the file atomically and verifies each part. ending: "stl", "ply", "obj" or "3mf".
   Errors: another extension, cancelled, any file error; then the old file is unchanged. */
bool wr_solid_body_write(const WrSolidBody *body, const char *ending, const char *path,
                         WrError *err);

/* ---- mesh_relief.c ---- */

/* The relief on the job's imported mesh; stores the error and other facts in the job's report. Errors: no
   texture coordinates, too many triangles, cancelled. body: zero-initialised. */
bool wr_mesh_relief_make(WrExportJob *job, WrSolidBody *body, WrError *err);

/* ---- distance of a point from a triangle ---- */

typedef struct WrFacet {
    WrVec3 p[3], side[3]; /* side k runs from corner k to the next */
    WrVec3 in[3];         /* across side k, inwards */
    WrVec3 n;             /* unit */
    double length2[3];
    bool flat; /* it has no area, only sides */
} WrFacet;

static inline WrFacet wr_facet_of(const WrSolidBody *body, const int32_t points[3])
{
    WrFacet f;
    for (int k = 0; k < 3; k++) f.p[k] = wr_solid_body_point(body, points[k]);
    for (int k = 0; k < 3; k++) {
        f.side[k] = v3_sub(f.p[(k + 1) % 3], f.p[k]);
        f.length2[k] = v3_dot(f.side[k], f.side[k]);
    }
    const WrVec3 n = v3_cross(f.side[0], f.side[1]);
    f.flat = !(v3_len(n) > 1e-12 * (f.length2[0] + f.length2[1]));
    f.n = v3_unit(n, (WrVec3){ 0, 0, 0 });
    for (int k = 0; k < 3; k++) f.in[k] = v3_cross(f.n, f.side[k]);
    return f;
}

/* Squared distance from side k as a segment. */
static inline double wr_facet_side2(const WrFacet *f, int k, WrVec3 p)
{
    const WrVec3 q = v3_sub(p, f->p[k]);
    const double along = f->length2[k] > 0 ? v3_dot(q, f->side[k]) / f->length2[k] : 0.0;
    const double part = along < 0.0 ? 0.0 : along > 1.0 ? 1.0 : along;
    const WrVec3 d = v3_mad(q, f->side[k], -part);
    return v3_dot(d, d);
}

/* Squared distance of a point. Inside the prism over the triangle it is the distance from the plane; outside, from the
   nearest side as a segment. */
static inline double wr_facet_distance2(const WrFacet *f, WrVec3 p)
{
    bool over = !f->flat;
    for (int k = 0; k < 3 && over; k++) over = v3_dot(v3_sub(p, f->p[k]), f->in[k]) >= 0.0;
    if (over) {
        const double h = v3_dot(v3_sub(p, f->p[0]), f->n);
        return h * h;
    }
    const double a = wr_facet_side2(f, 0, p), b = wr_facet_side2(f, 1, p),
                 c = wr_facet_side2(f, 2, p);
    return a < b ? a < c ? a : c : b < c ? b : c;
}
