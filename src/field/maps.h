/* maps.h - derived maps of a height table, as rows of one table; used by exports and canvas views.
 *
 * | map       | value of a texel                                                                  |
 * | occlusion | visible fraction of the sky above its plane, 0..1 (occlusion.h)                   |
 * | cavity    | min(0, F - blurred F) height, scene units: depth below its neighbourhood          |
 * | curvature | minus the mean curvature (derivatives.h), 1 / scene unit: ridges above 0, grooves below |
 * | slope     | angle of its plane, degrees 0..90                                                 |
 * | direction | downhill, degrees 0..360 anticlockwise from u; 0 where it is level                |
 * | roughness | root of alpha, at most 1: alpha^2 = base^2 + the sum of the variances of both slopes   |
 * |           | over a box about it, the mean of Beckmann's alpha^2 over the principal axes, each of which |
 * |           | is twice its variance                                                               |
 * | slope_u, slope_v | dz/dx along u, dz/dy along v: scene units over scene units                       |
 *
 * A table shifted by whole texels along its periodic axes produces the shifted map, to the bit, on any
 * number of threads. */
#pragma once
#include "field/derivatives.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;

typedef struct WrMapJob {
    WrDerivatives ground;  /* heights are always those of its field, also if slopes come from its
                              formula */
    int directions, reach; /* occlusion */
    double sigma;          /* cavity, texels, > 0 */
    int box;               /* roughness: texels along a side, odd, 1..WR_FIELD_MAP_BOX */
    double base;           /* roughness: alpha of the material itself, 0..1 */
} WrMapJob;

#define WR_FIELD_MAP_BOX 255

WrMapJob wr_map_default(const WrDerivatives *ground);

typedef struct WrFieldMap {
    const char *name;
    /* out: [h][part.pitch]. Errors: out of memory; cancelled. Non-finite results become 0 and are
     * counted. */
    bool (*make)(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                 int64_t *replaced, WrError *err);
    /* Distance in texels up to which heights affect a texel; -1: unlimited. */
    int (*support)(const WrMapJob *job);
} WrFieldMap;

typedef enum WrFieldMapKind {
    WR_FIELD_MAP_OCCLUSION,
    WR_FIELD_MAP_CAVITY,
    WR_FIELD_MAP_CURVATURE,
    WR_FIELD_MAP_SLOPE,
    WR_FIELD_MAP_DIRECTION,
    WR_FIELD_MAP_ROUGHNESS,
    WR_FIELD_MAP_SLOPE_U,
    WR_FIELD_MAP_SLOPE_V,
    WR_FIELD_MAP_COUNT
} WrFieldMapKind;

extern const WrFieldMap wr_field_maps[WR_FIELD_MAP_COUNT];

/* Calls wr_field_maps[kind].make for a part of the table, or for all of it. */
bool wr_map_make(WrFieldMapKind kind, const WrMapJob *job, const WrMapPart *part, WrPool *pool,
                 float *out, int64_t *replaced, WrError *err);
