/* solid_body.h - triangles of a solid in millimetres, and their files: STL, PLY, OBJ, 3MF.
   Private to this module. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

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
