/* maps.h - maps of a table, as rows of one table: exports and views of the canvas are made of them.

   | map       | a texel holds                                                                     |
   | occlusion | what its plane sees of the sky, 0..1 (occlusion.h)                                |
   | cavity    | min(0, F - blurred F) height, scene units: how deep it lies in what is about it   |
   | curvature | minus the mean curvature (derivatives.h), 1 / scene unit: ridges above 0, grooves below |
   | slope     | the angle of its plane, degrees 0..90                                             |
   | direction | downhill, degrees 0..360 anticlockwise from u; 0 where it is level                |
   | roughness | root of alpha, at most 1: alpha^2 = base^2 + the sum of the variances of both slopes over a box about it, |
   |           | which is the mean of Beckmann's alpha^2 over the principal axes, each twice its variance               |

   | slope_u, slope_v | dz/dx along u, dz/dy along v: scene units over scene units                       |

   A table that is moved by whole texels over its periodic axes gives the moved map, to the bit, on any number of threads. */
#pragma once
#include "field/derivatives.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;

typedef struct WrMapJob {
    WrDerivatives ground; /* heights are those of its field, also where slopes are of its formula */
    int directions, reach; /* occlusion */
    double sigma;          /* cavity, texels, > 0 */
    int box;               /* roughness: texels along a side, odd, 1..WR_FIELD_MAP_BOX */
    double base;           /* roughness: alpha of the material itself, 0..1 */
} WrMapJob;

#define WR_FIELD_MAP_BOX 255

WrMapJob wr_map_default(const WrDerivatives *ground);

typedef struct WrFieldMap {
    const char *name;
    /* out: [h][part.pitch]. Errors: no memory; cancelled. Texels whose numbers were not finite become 0 and are counted. */
    bool (*make)(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                 int64_t *replaced, WrError *err);
    /* How far from a texel its number depends on heights, in texels; -1: as far as there are any. */
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

/* As wr_field_maps[kind].make: of a part of the table, or of all of it. */
bool wr_map_make(WrFieldMapKind kind, const WrMapJob *job, const WrMapPart *part, WrPool *pool,
                 float *out, int64_t *replaced, WrError *err);
